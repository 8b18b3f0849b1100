"""Identified parameters: response, data, residuals, the motion, the search, and what is known beyond the fit."""

from dalembert.inverse import Fit, Population, Prediction, Profiles
from dalembert.multibody import Trajectory
from dalembert.report.asked import Asked
from dalembert.report.digits import counted, shown, with_deviation
from dalembert.report.headline import Headline, few
from dalembert.report.registry import sections_of
from dalembert.report.section import Listed, Section
from dalembert.report.sections.identification.estimates import estimates
from dalembert.report.sections.identification.identifiability import identifiability
from dalembert.report.sections.identification.population import varied
from dalembert.report.sections.identification.prediction import predicted
from dalembert.report.sections.identification.profiles import profiled
from dalembert.report.sections.identification.residuals import residuals
from dalembert.report.sections.identification.response import compared, experiments
from dalembert.report.sections.identification.search import search
from dalembert.report.sections.identification.shooting import shooting
from dalembert.report.sections.identification.verdict import identified
from dalembert.report.sections.motion.diagnostics import diagnostics
from dalembert.report.sections.motion.mechanism import mechanisms


@sections_of(Fit)
def fit(result: Fit, asked: Asked) -> list[Section]:
    """Estimates, the response against the data, the residuals, the motion, the search, and what is known beyond."""
    moving, profiles, predictions = asked.each(Trajectory), asked.one(Profiles), asked.each(Prediction)
    population = asked.one(Population)
    data = {"": result.data, **{item.name: item.data for item in result.experiments}}
    return [
        _headline(result),
        estimates(result),
        experiments(result) if result.experiments else compared(result),
        *residuals(result),
        *mechanisms(moving, asked.points, data),
        *search(result),
        *([] if result.nodes is None else [shooting(result, result.nodes)]),
        identifiability(result),
        *([varied(population, Listed([str(one) for one in population.findings]))] if population is not None else []),
        *([profiled(profiles)] if profiles is not None else []),
        *([predicted(predictions)] if predictions else []),
        *([diagnostics(moving)] if moving else []),
    ]


def _headline(result: Fit) -> Headline:
    converged = sum(start.success for start in result.starts)
    facts = {
        **few(result.parameters, map(with_deviation, result.values, result.deviations)),
        "misfit": shown(result.fitness, digits=3),
        "simulations": counted(result.simulations),
    }
    if len(result.starts) > 1:
        facts["starts converged"] = f"{converged} of {len(result.starts)}"
    return identified(result, "Identified parameters", facts)
