"""A motion in time: the mechanism, and its diagnostics."""

import numpy as np

from dalembert.multibody import Trajectory
from dalembert.report.asked import Asked
from dalembert.report.digits import counted, percent, shown
from dalembert.report.headline import Headline
from dalembert.report.registry import sections_of
from dalembert.report.section import Section
from dalembert.report.sections.motion.diagnostics import diagnostics, largest
from dalembert.report.sections.motion.mechanism import mechanisms
from dalembert.report.sections.motion.outputs import asked_channels, outputs


@sections_of(Trajectory)
def trajectory(result: Trajectory, asked: Asked) -> list[Section]:
    """The mechanism in motion, the asked channels over time, and the diagnostics."""
    moving = {"": result}
    channels = asked_channels(result, asked.channels, asked.points)
    return [
        motion_headline(result),
        *mechanisms(moving, asked.points),
        *outputs(result, channels),
        diagnostics(moving),
    ]


def motion_headline(result: Trajectory) -> Headline:
    """What was simulated, and how far it can be trusted."""
    times, balance = np.asarray(result.times), largest(result.energies, "balance")
    swing = max((float(np.ptp(values)) for key, values in result.energies.items() if key != "balance"), default=0.0)
    status = "The motion was simulated to its end."
    if swing > 0 and np.isfinite(balance):
        kept = f"The energy balance is kept to {percent(balance / swing, 2)} of the energy that moves; "
        status = f"{kept}a smaller step lowers it."
    return Headline(
        title="Simulated motion",
        verdict="simulated",
        status=status,
        facts={
            "simulated": shown(float(times[-1] - times[0])) + " s",
            "steps": counted(len(result.newton_iterations)),
            "largest energy error": shown(balance, digits=3) + " J",
            "largest opening of a joint": shown(largest(result.violations, "position"), digits=3) + " m",
        },
    )
