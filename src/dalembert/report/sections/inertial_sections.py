"""Inertial parameters of robots: torques along motions, and exciting trajectories."""

from dalembert.inverse.inertial import ConsistentInertias, ExcitingTrajectory, TorquePrediction
from dalembert.report import charts
from dalembert.report.headline import headline_of
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Plot, Section, by_name


@sections_of(ConsistentInertias)
def consistent(result: ConsistentInertias | TorquePrediction, options: ReportOptions) -> list[Section]:
    """Links, other parameters, base parameters and noise."""
    tables = by_name(result.tables())
    headings = {"Links": "links", "Parameters": "parameters", "Base parameters": "base", "Torques": "noise"}
    return [headline_of(result), *(Section(heading, tables[name]) for heading, name in headings.items())]


@sections_of(TorquePrediction)
def torque_prediction(result: TorquePrediction, options: ReportOptions) -> list[Section]:
    """Sections of the inertias, with the torques of the fitted motion, and of the unseen one."""
    how = "Below, predicted minus measured; dotted: two standard deviations of the noise."
    records = {
        "fitted": (result.times, result.measured, result.predicted),
        "unseen": (result.unseen_times, result.unseen_measured, result.unseen_predicted),
    }
    sections = consistent(result, options)
    for name, (times, measured, predicted) in records.items():
        if not len(times):
            continue
        noise = result.inertias.noise.tolist()
        plots = [
            Plot(
                f"{name}-torques-{k + 1}",
                charts.torques(times, measured[:, k], predicted[:, k], noise[k], title=joint),
                how,
            )
            for k, joint in enumerate(result.inertias.joints)
        ]
        tables = by_name(result.tables())["prediction"] if name == "unseen" else []
        sections.append(Section(f"Torques of the {name} motion", (*plots, *tables)))
    return sections


@sections_of(ExcitingTrajectory)
def exciting(result: ExcitingTrajectory, options: ReportOptions) -> list[Section]:
    """The motion, and the largest velocities and accelerations with their limits."""
    plot = Plot("exciting-motion", charts.exciting_motion(result), "One period; it can be repeated without a jump.")
    return [headline_of(result), Section("Motion", (plot, *result.tables()))]
