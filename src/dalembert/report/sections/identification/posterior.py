"""A posterior: its marginals beside what linear deviations and profiles say, pairs, traces and predictive bands."""

import numpy as np

from dalembert.inverse import Posterior, Profiles
from dalembert.quantities import by_quantity
from dalembert.report import charts
from dalembert.report.headline import Headline
from dalembert.report.look import plain
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Plot, Row, Section
from dalembert.report.sections.identification.assessment import profiled
from dalembert.results import fixed_facts
from dalembert.tables import Table, cell, cells, counted, few_values, interval, with_deviation

MARGINAL = (
    "Bars are the draws, between dotted lines 95 % of them. Dashed is the normal distribution of the linearised "
    "response, dotted the prior."
)
PROFILE = " The solid line is the profile likelihood, scaled to the same area."
PAIRS = "Each point is a draw. A curved or broken cloud cannot be described by deviations and correlations."
TRACE = "Chains that have converged overlap and do not drift."
BAND = "The band contains a new measurement with 95 %. Below, the data less the middle of the band."


@sections_of(Posterior)
def posterior(told: Posterior, options: ReportOptions) -> list[Section]:
    """Headline, parameters with their marginals, pairs, traces and the predictive bands."""
    profiles = options.first(Profiles)
    chains, draws, _ = told.draws.shape
    texts = [with_deviation(float(m), float(d)) for m, d in zip(told.mean, told.deviations, strict=True)]
    facts = {
        **few_values(told.parameters, texts),
        **fixed_facts(told),
        "draws": f"{counted(chains)} chains × {counted(draws)}",
        "sampler": told.sampler,
        "simulations": counted(told.simulations),
    }
    headline = Headline(
        title="Posterior",
        verdict="sampled" if told.success else "not converged",
        success=told.success,
        status=told.status,
        facts=facts,
        findings=told.findings,
    )
    further = [] if profiles is None else [profiled(profiles)]
    return [headline, _parameters(told, profiles), *_pairs(told), _traces(told), _predictive(told), *further]


def _parameters(told: Posterior, profiles: Profiles | None) -> Section:
    how = MARGINAL + (PROFILE if profiles is not None else "")
    names = told.parameters.names
    plots = [Plot(f"marginal-{k}", charts.marginal(told, name, profiles), how) for k, name in enumerate(names, 1)]
    return Section("Parameters", (_table(told, profiles), Row(plots, side_by_side=len(plots) > 1)))


def _table(told: Posterior, profiles: Profiles | None) -> Table:
    linear = told.mode - 1.959964 * told.linear_deviations, told.mode + 1.959964 * told.linear_deviations
    sampled = np.array([told.intervals()[name] for name in told.parameters.names])
    columns = {
        "parameter": told.parameters.names,
        "mean": [cell(mean, deviation) for mean, deviation in zip(told.mean, told.deviations, strict=True)],
        "standard deviation": cells(told.deviations, 2),
        "95 % of the posterior": [interval(*ends) for ends in sampled],
        "95 % linearised": [interval(*ends) for ends in zip(*linear, strict=True)],
    }
    if profiles is not None:
        ends = profiles.intervals
        texts = [interval(*ends[name]) if name in ends else "" for name in told.parameters.names]
        columns[f"{100 * profiles.level:g} % of the profile"] = texts
    columns |= {
        "unit": [item.unit for item in told.parameters],
        "R-hat": cells(told.r_hat, 4),
        "effective draws, centre": cells(told.bulk, 3),
        "effective draws, tails": cells(told.tail, 3),
        "error of the mean": cells(told.errors, 2),
    }
    return Table.of("posterior", "Posterior of the parameters", columns)


def _pairs(told: Posterior) -> list[Section]:
    if len(told.parameters) < 2:
        return []
    return [Section("Pairs", (Plot("pairs", charts.pair_plots(told), PAIRS),))]


def _traces(told: Posterior) -> Section:
    names = told.parameters.names
    plots = [Plot(f"trace-{k}", charts.traces(told, name), TRACE) for k, name in enumerate(names, 1)]
    return Section("Traces", (Row(plots, side_by_side=len(plots) > 1),))


def _predictive(told: Posterior) -> Section:
    plots = [
        Plot(f"predictive-{k}", charts.predictive(told, chosen, title=", ".join(map(plain, chosen))), BAND)
        for k, chosen in enumerate(by_quantity(told.data.channels), 1)
    ]
    return Section("Predictive bands", tuple(plots))
