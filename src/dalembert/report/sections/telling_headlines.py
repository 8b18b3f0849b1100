"""The first lines of a report on what data can tell: profiles, predictions, designs."""

from collections.abc import Sequence

from dalembert.inverse import Designs, Prediction, Profiles
from dalembert.report.digits import counted, interval, shown
from dalembert.report.quantities import labelled
from dalembert.report.sections.headline import MOST_VALUES, Fact, Headline


def of_profiles(told: Profiles, title: str | None, notes: Sequence[str]) -> Headline:
    """Headline of profile likelihoods."""
    units = {item.name: item.unit for item in told.parameters}
    values = [
        Fact(labelled(curve.name, units[curve.name]), interval(curve.lower, curve.upper)) for curve in told.curves
    ]
    facts = [
        *(values if len(values) <= MOST_VALUES else []),
        Fact("level", f"{100 * told.level:g} %"),
        Fact("simulations", counted(told.simulations)),
    ]
    verdict = "profiled" if told.success else "not settled"
    return Headline(title or "Profile likelihood", verdict, told.success, told.status, facts, notes)


def of_prediction(told: Prediction, title: str | None, notes: Sequence[str]) -> Headline:
    """Headline of a prediction."""
    facts = [Fact("level", f"{100 * told.level:g} %"), Fact("channels", counted(len(told.channels)))]
    verdict = "predicted" if told.success else "not bounded"
    return Headline(title or "Predicted response", verdict, told.success, told.status, facts, notes)


def of_designs(told: Designs, title: str | None, notes: Sequence[str]) -> Headline:
    """Headline of designs."""
    facts = [
        Fact("best sensors", ", ".join(told.sensors[0])),
        Fact(f"until {told.along}", f"{shown(float(told.horizons[0]))} {told.unit}".rstrip()),
        Fact("criterion", told.criterion),
        Fact("designs", counted(len(told.scores))),
    ]
    verdict = "ranked" if told.success else "not told"
    return Headline(title or "Design of the experiment", verdict, told.success, told.status, facts, notes)
