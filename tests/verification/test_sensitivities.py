"""Exact sensitivities against published ones."""

import numpy as np
from scipy.integrate import simpson

import dalembert as da


def slider_crank(model: dict, initial: dict, stiffness: float, damping: float) -> da.System:
    """Spring-damper between the middles of crank and rod, force on the rod; the rod's mass stands at the slider."""
    a, b = model["crank_length"], model["rod_length"]
    q = initial["crank_angle"]
    p = np.arcsin(-a / b * np.sin(q))
    system = da.System(gravity=(0.0, 0.0))
    # The crank turns about its centre of mass: its own mass does not move.
    crank = system.add(
        da.RigidBody("crank", 1.0, model["crank_inertia"], angle=q, points={"pin": (a, 0.0), "middle": (a / 2, 0.0)})
    )
    along = {"pin": (-b, 0.0), "middle": (-b / 2, 0.0), "force": (model["force_point"], 0.0)}
    rod = system.add(
        da.RigidBody(
            "rod", model["rod_mass"], model["rod_inertia"], crank.point("pin"), angle=p, anchor="pin", points=along
        )
    )
    system.add(da.RevoluteJoint("O", system.ground, crank.centre))
    system.add(da.RevoluteJoint("A", crank.point("pin"), rod.point("pin")))
    system.add(da.PrescribedMotion("slide", system.ground.point(0.0, 0.0), rod.centre, coordinate="y", motion=0.0))
    middles = crank.point("middle"), rod.point("middle")
    system.add(da.Spring("spring", *middles, stiffness, damping=damping, free_length=model["free_length"]))
    system.add(da.Force("push", rod.point("force"), x=model["force"]))
    return system


def test_slider_crank(reference, record_evidence) -> None:
    data = reference("slider_crank_sensitivity")
    values = data["values"]
    times = np.linspace(0.0, values["end"], 2001)
    model = da.TimeResponse(
        lambda stiffness, damping: slider_crank(data["model"], data["initial"], stiffness, damping),
        parameters={"stiffness": (0.5, 2.0), "damping": (0.5, 2.0)},
        channels=["system.kinetic_energy"],
        times=times,
        solver=da.GeneralizedAlpha(step=5e-4, spectral_radius=0.9),
    )
    response, jacobian = model.linearise(np.array([1.0, 1.0]))
    common = {
        "topic": "Sensitivities",
        "kind": data["kind"],
        "source": data["source"],
        "relative": True,
        "tolerance": 1e-7,
    }
    record_evidence(
        "slider-crank, integral of the kinetic energy",
        values["kinetic_energy_integral"],
        simpson(response[:, 0], x=times),
        unit="J s",
        **common,
    )
    for column, (name, unit) in enumerate({"by_stiffness": "J s m/N", "by_damping": "J m/N"}.items()):
        record_evidence(
            f"slider-crank, its derivative {name.replace('_', ' ')}",
            values[name],
            simpson(jacobian[:, 0, column], x=times),
            unit=unit,
            **common,
        )
