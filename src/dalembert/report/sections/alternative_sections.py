"""Other answers than a fit: posteriors, consistent sets, smooth parameters, and several models of the same data."""

from dalembert.inverse import CrossValidation, ModelComparison, ParameterSet, Posterior, Profiles, RegularisedFit
from dalembert.quantities import by_quantity
from dalembert.report import charts
from dalembert.report.charts.identification.paving import planes
from dalembert.report.headline import headline_of
from dalembert.report.look import plain
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Download, Listed, Plot, Row, Section, by_name
from dalembert.report.sections.assessment_sections import profiled
from dalembert.report.sections.response_sections import compared_simply

PAVING = "Every point of a consistent box explains all data within their errors; an undecided box may hold some."
MARGINAL = (
    "Bars are the draws, between dotted lines 95 % of them. Dashed is the normal distribution of the linearised "
    "response, dotted the prior."
)
PROFILE = " The solid line is the profile likelihood, scaled to the same area."
PAIRS = "Each point is a draw. A curved or broken cloud cannot be described by deviations and correlations."
TRACE = "Chains that have converged overlap and do not drift."
BAND = "The band contains a new measurement with 95 %. Below, the data less the middle of the band."
LEFT_OUT = "Lines are predicted by the fits without each group, circles are data; below, predicted minus measured."
DIFFERENCES = "Differences to the best model, with two standard deviations. A difference below 4 means nothing."
BY_GROUP = "The sum over the groups in the order of the data. A step is a part of the data that a model predicts worse."
SMOOTH = "The band is two standard deviations, with the penalty as a prior."
PENALTY = "A larger weight gives smoother parameters and a larger residual. The weight is chosen at the corner."


@sections_of(ParameterSet)
def parameter_set(result: ParameterSet, options: ReportOptions) -> list[Section]:
    """Outer and inner box, and the paving in the planes of the parameters."""
    plots = [
        Plot(f"paving-{place}", charts.paving(result, plane, truth=options.truth), PAVING)
        for place, plane in enumerate(planes(result.parameters.names), start=1)
    ]
    success = result.success and not result.empty
    return [headline_of(result, success=success), Section("Consistent set", (*result.tables(), Row(plots)))]


@sections_of(Posterior)
def posterior(result: Posterior, options: ReportOptions) -> list[Section]:
    """Parameters with their marginals, pairs, traces and the predictive bands."""
    profiles, names = options.first(Profiles), result.parameters.names
    how, beside = MARGINAL + (PROFILE if profiles is not None else ""), len(names) > 1
    marginals = [Plot(f"marginal-{k}", charts.marginal(result, name, profiles), how) for k, name in enumerate(names, 1)]
    traces = [Plot(f"trace-{k}", charts.traces(result, name), TRACE) for k, name in enumerate(names, 1)]
    bands = [
        Plot(f"predictive-{k}", charts.predictive(result, chosen, title=", ".join(map(plain, chosen))), BAND)
        for k, chosen in enumerate(by_quantity(result.data.channels), 1)
    ]
    return [
        headline_of(result),
        Section("Parameters", (*result.tables(profiles), Row(marginals, beside))),
        *([Section("Pairs", (Plot("pairs", charts.pair_plots(result), PAIRS),))] if beside else []),
        Section("Traces", (Row(traces, beside),)),
        Section("Predictive bands", bands),
        *([] if profiles is None else [profiled(profiles)]),
    ]


@sections_of(RegularisedFit)
def regularised_fit(result: RegularisedFit, options: ReportOptions) -> list[Section]:
    """The parameters, the L-curve, and the response."""
    tables = by_name(result.tables())
    plots = [
        Plot("smooth-parameters", charts.smooth_parameters(result), SMOOTH),
        Plot("penalty-curve", charts.penalty_curve(result), PENALTY),
    ]
    downloads = [Download(table, "Download all values as CSV") for table in tables["values"]]
    values = Section("Values and penalty", (Row(plots), *tables["other-values"], *downloads))
    return [headline_of(result), values, compared_simply(result, tables["residuals"])]


@sections_of(CrossValidation)
def cross_validation(result: CrossValidation, options: ReportOptions) -> list[Section]:
    """The errors and values of each group, and the predictions of a single record."""
    groups, *residuals = result.tables()
    sections = [headline_of(result), Section("Groups that were left out", (groups,))]
    return sections if result.fit.experiments else [*sections, compared_simply(result, residuals, LEFT_OUT)]


@sections_of(ModelComparison)
def model_comparison(result: ModelComparison, options: ReportOptions) -> list[Section]:
    """The ranking, and its section."""
    return [headline_of(result), compared_models(result)]


def compared_models(result: ModelComparison, *, findings: bool = False) -> Section:
    """The section on the models; with their findings where no headline has them."""
    sentences = [str(item) for item in result.findings] if findings else []
    plots = [
        Plot("model-differences", charts.model_differences(result), DIFFERENCES),
        Plot("difference-by-group", charts.difference_by_group(result), BY_GROUP),
    ]
    return Section("Model comparison", (Listed(sentences), *result.tables(), Row(plots, side_by_side=False)))
