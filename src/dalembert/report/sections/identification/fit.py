"""Identified parameters, and intervals identified from bands."""

from dalembert.inverse import BandFit, Fit, Population, Prediction, Profiles
from dalembert.multibody import Trajectory
from dalembert.quantities import by_quantity
from dalembert.report import charts
from dalembert.report.look import plain
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Plot, Section, by_name, samples
from dalembert.report.sections.identification.assessment import predicted, profiled, varied
from dalembert.report.sections.identification.response import compared, residuals
from dalembert.report.sections.identification.search import identifiability, identified, search
from dalembert.report.sections.motion.trajectory import diagnostics, mechanisms


@sections_of(Fit)
def fit(result: Fit, options: ReportOptions) -> list[Section]:
    """Estimates, the response against the data, the residuals, the motion, the search, and what is known beyond."""
    moving, profiles, predictions = options.each(Trajectory), options.first(Profiles), options.each(Prediction)
    population, known, tables = options.first(Population), result.identifiability(), by_name(result.tables())
    data = {"": result.data, **{item.name: item.data for item in result.experiments}}
    caption = "Each value where it lies between its bounds; bars are two standard deviations."
    bars = Plot("parameters", charts.parameters(result), caption)
    sections = [
        identified(result, known),
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
        identified(result, known),
        Section("Parameters", (*tables["intervals"], bars)),
        Section("Bands", (*plots, *tables["band-residuals"], download)),
        *search(result, tables["starts"]),
        identifiability(result, known),
    ]
