"""Inertial parameters of robots: consistent estimates, base parameters, exciting trajectories, recovery."""

from dataclasses import replace

import numpy as np

from dalembert.inverse.inertial import (
    BaseEstimate,
    BaseParameters,
    ConsistentInertias,
    ExcitingTrajectory,
    Recovery,
    TorquePrediction,
)
from dalembert.report import charts
from dalembert.report.headline import Headline
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Fold, Plot, Section
from dalembert.tables import Table, cell, cells, counted, shown
from dalembert.units import inertial_unit


@sections_of(ConsistentInertias)
def consistent(found: ConsistentInertias, options: ReportOptions) -> list[Section]:
    """Links, other parameters, base parameters and noise."""
    count, few = 10 * len(found.links), found.deviations
    links = {
        "link": found.links,
        "mass (kg)": cells(found.values[:count:10]),
        "prior mass (kg)": cells(found.prior[:count:10]),
        "distance from the prior": cells(found.distances, 4),
        "smallest eigenvalue": cells(found.eigenvalues, 4),
        "without conditions": [cell(float(one), digits=4, mark=bool(one <= 0)) for one in found.plain_eigenvalues],
    }
    every = {
        "parameter": found.names,
        "value": map(cell, found.values, few),
        "standard deviation": cells(few, 2),
        "prior": cells(found.prior),
        "unit": map(inertial_unit, found.names),
    }
    caption = "Smallest eigenvalue of each pseudo-inertia, relative to the prior one: positive for a possible body"
    headline = Headline.of(
        "Inertial parameters",
        found.success,
        ("identified", "not identified"),
        found.status,
        {
            "links": counted(len(found.links)),
            "base parameters": counted(found.base.rank),
            "regularisation": shown(found.regularisation),
        },
    )
    return [
        headline,
        Section("Links", (Table.of("links", caption, links),)),
        Section("Parameters", (Fold(Table.of("parameters", "All parameters", every), rows="parameters"),)),
        _base(found.base, found.base_values, found.base_deviations),
        _noise(found.joints, found.noise, found.residual),
    ]


@sections_of(TorquePrediction)
def torque_prediction(found: TorquePrediction, options: ReportOptions) -> list[Section]:
    """Sections of the inertias, with the torques of the fitted motion, and of the unseen one."""
    headline, *others = consistent(found.inertias, options)
    assert isinstance(headline, Headline)
    records = [("fitted", found.times, found.measured, found.predicted)]
    if len(found.unseen_times):
        worst = f"{shown(float(found.ratios.max()), digits=4)} times the noise"
        headline = replace(headline, facts={**headline.facts, "prediction, worst joint": worst})
        records.append(("unseen", found.unseen_times, found.unseen_measured, found.unseen_predicted))
    drawn = []
    for name, times, measured, predicted in records:
        plots = [
            Plot(
                f"{name}-torques-{k + 1}",
                charts.torques(times, measured[:, k], predicted[:, k], float(found.inertias.noise[k]), title=joint),
                "Below, predicted minus measured; dotted: two standard deviations of the noise.",
            )
            for k, joint in enumerate(found.inertias.joints)
        ]
        drawn.append(Section(f"Torques of the {name} motion", (*plots, *_prediction(found, name))))
    return [headline, *others, *drawn]


def _prediction(found: TorquePrediction, name: str) -> list[Table]:
    """Rms errors of the unseen motion relative to the noise."""
    if name != "unseen":
        return []
    columns = {"joint": found.inertias.joints, "error / noise": cells(found.ratios, 4)}
    caption = (
        f"Rms error of the predicted torques; noise alone exceeds {shown(found.most, digits=4)} in 0.1 % of records"
    )
    return [Table.of("prediction", caption, columns)]


@sections_of(BaseEstimate)
def base_estimate(found: BaseEstimate, options: ReportOptions) -> list[Section]:
    """Base parameters and noise."""
    success = not any(one.severity == "error" for one in found.outcome)
    facts = {"base parameters": counted(found.base.rank), "joints": counted(len(found.joints))}
    headline = Headline.of("Base parameters", success, ("identified", "not identified"), found.status, facts)
    return [headline, _base(found.base, found.values, found.deviations), _noise(found.joints, found.noise, None)]


@sections_of(BaseParameters)
def base_parameters(found: BaseParameters, options: ReportOptions) -> list[Section]:
    """Combinations in words."""
    facts = {"rank": f"{found.rank} of {len(found.names)}", "condition number": shown(found.condition, digits=4)}
    headline = Headline.of("Base parameters", True, ("computed", ""), "", facts)
    table = Table.of("base", "Combinations that torques depend on", {"base": found.base, "combination": found.words})
    return [headline, Section("Combinations", (Fold(table, rows="combinations"),))]


@sections_of(ExcitingTrajectory)
def exciting(found: ExcitingTrajectory, options: ReportOptions) -> list[Section]:
    """The motion, and the largest velocities and accelerations with their limits."""
    _, velocities, accelerations = found.motion.motion(np.linspace(0.0, found.motion.period, 1001))
    table = {
        "joint": found.joints,
        "lower limit": cells(found.limits.lower),
        "upper limit": cells(found.limits.upper),
        "largest velocity": cells(np.abs(velocities).max(axis=0), 4),
        "limit of velocity": cells(found.limits.velocity),
        "largest acceleration": cells(np.abs(accelerations).max(axis=0), 4),
        "limit of acceleration": cells(found.limits.acceleration),
    }
    facts = {
        "period": f"{shown(found.motion.period)} s",
        "condition number": shown(found.condition, digits=4),
        "of random motions": shown(found.usual_condition, digits=4),
    }
    headline = Headline.of("Exciting trajectory", True, ("found", ""), found.status, facts)
    plot = Plot("exciting-motion", charts.exciting_motion(found), "One period; it can be repeated without a jump.")
    return [headline, Section("Motion", (plot, Table.of("limits", "Limits of the joints", table)))]


@sections_of(Recovery)
def recovery(found: Recovery, options: ReportOptions) -> list[Section]:
    """Coverage of each base parameter."""
    shares = {
        "base parameter": found.base,
        "coverage": cells(found.coverage, 3),
        "without prior": cells(found.plain_covered.mean(axis=0), 3),
    }
    worst = float(np.max(found.prediction / found.unseen_noise))
    facts = {
        "runs": counted(len(found.prediction)),
        "coverage": f"{shown(100 * float(found.covered.mean()), digits=4)} %, nominal {shown(100 * found.level)} %",
        "prediction, worst run": f"{shown(worst, digits=4)} times the noise",
        "consistent links": f"{shown(100 * float(found.consistent.mean()), digits=4)} %",
    }
    headline = Headline.of("Simulated recovery", True, ("computed", ""), "", facts)
    table = Table.of("coverage", "Share of intervals that contain the true value", shares)
    return [headline, Section("Coverage", (Fold(table, rows="base parameters"),))]


def _base(base: BaseParameters, values: np.ndarray, deviations: np.ndarray) -> Section:
    columns = {
        "combination": base.words,
        "value": map(cell, values, deviations),
        "standard deviation": cells(deviations, 2),
        "unit": map(inertial_unit, base.base),
    }
    table = Table.of("base", "Base parameters: the combinations that torques determine", columns)
    return Section("Base parameters", (Fold(table, rows="combinations"),))


def _noise(joints: tuple[str, ...], noise: np.ndarray, residual: np.ndarray | None) -> Section:
    columns = {"joint": joints, "noise": cells(noise, 3)}
    if residual is not None:
        columns["rms residual"] = cells(residual, 3)
    caption = "Standard deviation of the noise of each joint, in N m, of a prismatic joint in N"
    return Section("Torques", (Table.of("noise", caption, columns),))
