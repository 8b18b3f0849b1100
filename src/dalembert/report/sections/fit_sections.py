"""Identified parameters, and intervals identified from bands."""

from collections.abc import Iterable

from dalembert.inverse import BandFit, Fit, Identifiability, Population, Prediction, Profiles
from dalembert.multibody import Trajectory
from dalembert.quantities import by_quantity
from dalembert.report import charts
from dalembert.report.charts.identification.identifiability import unknowns
from dalembert.report.charts.identification.regularisation import accounts
from dalembert.report.headline import Headline, headline_of
from dalembert.report.look import plain
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Listed, Plot, Row, Section, by_name, samples
from dalembert.report.sections.assessment_sections import predicted, profiled, varied
from dalembert.report.sections.motion_sections import diagnostics, mechanisms
from dalembert.report.sections.response_sections import compared, residuals
from dalembert.tables import Table


@sections_of(Fit)
def fit(result: Fit, options: ReportOptions) -> list[Section]:
    """Estimates, the response against the data, the residuals, the motion, the search, and what is known beyond."""
    moving, profiles, predictions = options.each(Trajectory), options.first(Profiles), options.each(Prediction)
    population, known, tables = options.first(Population), result.identifiability(), by_name(result.tables())
    data = {"": result.data, **{item.name: item.data for item in result.experiments}}
    caption = "Each value where it lies between its bounds; bars are two standard deviations."
    bars = Plot("parameters", charts.parameters(result), caption)
    sections = [
        identified(result),
        Section("Parameters", (*tables["parameters"], *tables["noise"], bars, *tables["halves"])),
        compared(result, tables["residuals"]),
        *residuals(result),
        *mechanisms(moving, options.points, data),
        *search(result, tables["starts"]),
    ]
    if result.nodes is not None:
        come = "The gaps weigh ever more until they are closed; where two segments merge, a gap opens once more."
        growth = f"{result.nodes.growth:.2g} times"
        text = f"{result.nodes} By the last of these states a small change of the initial state has grown {growth}."
        sections.append(Section("Multiple shooting", (text, Plot("gaps", charts.gaps(result), come), *tables["nodes"])))
    sections.append(identifiability(result, known))
    if population is not None:
        sections.append(varied(population, [str(finding) for finding in population.findings]))
    if profiles is not None:
        sections.append(profiled(profiles))
    if predictions:
        sections.append(predicted(predictions))
    return [*sections, *([diagnostics(moving)] if moving else [])]


@sections_of(BandFit)
def band_fit(result: BandFit, options: ReportOptions) -> list[Section]:
    """Intervals, the bands given and reproduced, and the search."""
    tables, bands, known = by_name(result.tables(options.truth)), result.bands, result.identifiability()
    caption = "Each interval where it lies between its search bounds; whiskers are two standard deviations of its ends"
    caption += ", diamonds the true ends." if options.truth else "."
    how = (
        "Filled: the bands given; dashed: reproduced with the identified intervals; below, reproduced minus "
        "given, lower bounds solid and upper ones dotted. Residuals that no noise explains say that no "
        "intervals give these bands."
    )
    plots = [
        Plot(f"residual-bands-{place}", charts.residual_bands(result, group, title=", ".join(map(plain, group))), how)
        for place, group in enumerate(by_quantity(bands.channels), start=1)
    ]
    series = {}
    for side, values in result.reproduced.items():
        series |= {f"{side} given": getattr(bands, side), f"{side} reproduced": values}
    download = samples("bands", bands.coordinate, bands.channels, series, "Download all samples as CSV")
    bars = Plot("intervals", charts.intervals(result, options.truth), caption)
    return [
        identified(result),
        Section("Parameters", (*tables["intervals"], bars)),
        Section("Bands", (*plots, *tables["band-residuals"], download)),
        *search(result, tables["starts"]),
        identifiability(result, known),
    ]


MOST_BESIDE = 3
"""Unknowns up to which the figures have room side by side: combinations of many have long names."""
GREW = "Fewer samples were fitted first: a line begins where all are compared, its simulations counting those before."
LEAST_SQUARES = ("LeastSquares", "ResponseSensitivity")
"""Methods whose horizon may grow."""


def identified(fit: Fit | BandFit) -> Headline:
    """Headline of something identified, with what speaks against it."""
    doubts = [doubt.message for doubt in fit.doubts] if fit.success else []
    return headline_of(fit, doubts=doubts, verdict=f"{fit.verdict}, with doubts" if doubts else fit.verdict)


def identifiability(fit: Fit | BandFit, known: Identifiability) -> Section:
    """Sentences on identifiability; of several unknowns, singular values and correlation."""
    plots, names = [], unknowns(fit)
    if len(names) > 1:
        pairs = "Near 1 or −1, the data determine a combination of the two parameters, but not each of them."
        small = "A small value belongs to a combination that is hardly identifiable."
        spectrum = charts.singular_values(known.singular_values, known.directions, names)
        plots = [Plot("correlation", charts.correlation(fit), pairs), Plot("singular-values", spectrum, small)]
    row = Row(plots, side_by_side=len(names) <= MOST_BESIDE)
    return Section("Identifiability", (Listed(str(known).splitlines()), row))


def search(fit: Fit | BandFit, tables: Iterable[Table]) -> list[Section]:
    """Convergence of every start or swarm, and where each start ended; nothing for a fit without a history."""
    if not fit.history:
        return []
    lines = "One line a start; the winning one in colour."
    plots = [Plot("convergence", charts.convergence(fit), f"{lines} {GREW}" if grew(fit) else lines)]
    if len(fit.starts) > 1:
        ends = "Starts in order of their final misfit; a flat step is a minimum that many starts lead to."
        plots.append(Plot("starts", charts.starts(fit), ends))
    if accounts(fit):
        corner = "The weight is chosen at the corner, and raised until the step goes as the linear model foresees."
        went = "Agreement is the fall of the sum of squares over the fall foreseen; 1 is just as foreseen."
        plots += [Plot("l-curve", charts.l_curve(fit), corner), Plot("steps", charts.steps(fit), went)]
    return [Section("Search", (Row(plots), *tables))]


def grew(fit: Fit | BandFit) -> bool:
    """Whether the horizon of the first start grew: more was simulated than the one linearised run of a first step."""
    facts = fit.provenance
    grows = facts.get("horizon") == "growing" and facts.get("method", {}).get("name") in LEAST_SQUARES
    first = next((step.simulations for step in fit.history if step.start == 0), 0)
    return grows and getattr(fit, "nodes", None) is None and first > 1 + len(fit.parameters)
