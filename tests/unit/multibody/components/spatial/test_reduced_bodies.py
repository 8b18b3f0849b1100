"""Reduced bodies: placing, markers, energies, drawings, findings and messages."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import dalembert.multibody as mb
import dalembert.multibody.spatial as sp
from dalembert.errors import InputError, ModelError
from dalembert.export.mechanism import motion as vtk_motion
from dalembert.multibody.components.spatial.modal_strains import largest_principal
from dalembert.multibody.components.spatial.reduced_body import coarse_surface
from dalembert.multibody.model.lowering import lower
from dalembert.report import Animation
from dalembert.report.player.film import encoded
from dalembert.structure import FreeBodyModes, Material, box, free_body_modes, solid, strain_between


@cache
def bar() -> FreeBodyModes:
    """A soft bar of solid elements along x."""
    mesh = box((0.4, 0.02, 0.03), (6, 2, 2), (0.1, 0.2, 0.3))
    return free_body_modes(solid(mesh, Material(2e9, 0.3, 1200.0)), {"foot": "left", "tip": "right"}, modes=4)


def hung(**options) -> sp.SpatialSystem:
    """The bar on a ball joint at its foot."""
    system = sp.SpatialSystem()
    body = system.add(sp.ReducedBody("bar", bar(), **options))
    system.add(
        sp.SphericalJoint("ball", system.ground.point(options.get("position", (0.0, 0.0, 0.0))), body.point("foot"))
    )
    return system


def positions(system: sp.SpatialSystem, *points: str) -> np.ndarray:
    """Initial positions of points of the bar."""
    names = [f"bar.{point}.{axis}" for point in points for axis in "xyz"]
    return mb.simulate(system, 1e-3, mb.GeneralizedAlpha(step=1e-3)).channels(names)[0].reshape(-1, 3)


def test_it_is_placed_by_any_of_its_points() -> None:
    turn = sp.Orientation.by_angles("z", np.pi / 2)
    points = {"eye": sp.NodePoint("tip", (0.0, 0.05, 0.0), sp.Orientation.by_angles("x", 0.3))}
    at = (1.0, 2.0, 3.0)
    system = hung(position=at, orientation=turn, anchor="foot", points=points)
    expected = [[1.0, 2.2, 3.0], [1.0, 2.0, 3.0], [1.0, 2.4, 3.0], [0.95, 2.4, 3.0]]
    np.testing.assert_allclose(positions(system, "centre", "foot", "tip", "eye"), expected, atol=1e-12)
    system = sp.SpatialSystem()
    system.add(sp.ReducedBody("bar", bar(), position=at, orientation=turn, anchor="eye", points=points))
    np.testing.assert_allclose(positions(system, "eye"), [at], atol=1e-12)


def test_it_stands_at_the_end_of_another_body() -> None:
    system = sp.SpatialSystem()
    rod = system.add(
        sp.RigidBody("rod", sp.Inertia.box(1.0, (0.1, 0.1, 0.1)), points={"end": (0.0, 0.0, -0.5)},
                     orientation=sp.Orientation.by_angles("y", np.pi / 2))
    )  # fmt: skip
    system.add(sp.ReducedBody("bar", bar(), position=rod.point("end"), anchor="foot"))
    np.testing.assert_allclose(positions(system, "foot", "tip"), [[-0.5, 0.0, 0.0], [-0.5, 0.0, -0.4]], atol=1e-12)


def test_the_energy_balance_holds_with_damping() -> None:
    motion = mb.simulate(hung(anchor="foot", damping_ratio=0.05), 0.3, mb.RadauIIA(tolerance=1e-9))
    energies = motion.energies
    assert np.abs(energies["balance"]).max() < 1e-6 * energies["kinetic"].max()
    assert (
        energies["kinetic"][-1] + energies["potential"][-1] < energies["kinetic"][0] + energies["potential"][0] - 1e-6
    )


def test_modal_damping_is_that_part_of_the_critical_one() -> None:
    system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
    system.add(sp.ReducedBody("bar", bar(), damping_ratio=0.03))
    modes = mb.modes(system)
    np.testing.assert_allclose(modes.damping_ratios[modes.frequencies > 1.0], 0.03, rtol=1e-6)


@pytest.mark.parametrize(
    "solver", [mb.Variational(1e-3), mb.EnergyMomentum(1e-3)], ids=lambda solver: type(solver).__name__
)
def test_midpoint_methods_say_what_they_need(solver) -> None:
    with pytest.raises(ModelError, match="needs masses that do not change with the coordinates"):
        mb.simulate(hung(anchor="foot"), 0.01, solver)


def test_methods_agree() -> None:
    tips = [
        mb.simulate(hung(anchor="foot"), 0.1, solver).channels(["bar.tip.x", "bar.tip.z"])[-1]
        for solver in (mb.RadauIIA(tolerance=1e-9), mb.GeneralizedAlpha(1e-4), "auto")
    ]
    np.testing.assert_allclose(tips[1:], [tips[0]] * 2, atol=2e-6)


def test_the_drawing_is_the_deformed_surface() -> None:
    system = hung(anchor="foot")
    body, model = system.bodies[0], lower(system)
    coordinates = model.x[None, : body.size].repeat(2, axis=0)
    coordinates[1, -bar().count] = 0.05
    surface = body.skin(coordinates)
    assert surface.corners.shape[0] == 2
    first, second = surface.corners
    assert np.ptp(first, axis=0) == pytest.approx([0.4, 0.02, 0.03])
    assert np.linalg.norm(second - first, axis=1).max() == pytest.approx(0.05, rel=1e-2)
    assert surface.triangles.max() == len(first) - 1
    lines = body.outline(coordinates, 2)
    np.testing.assert_allclose(lines[0], [[0.2, 0, 0], [0, 0, 0], [0.2, 0, 0], [0.4, 0, 0], [0.2, 0, 0]], atol=1e-12)


def strip() -> tuple[sp.SpatialSystem, sp.ReducedBody]:
    """The bar clamped at its foot, at rest at first."""
    system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
    body = system.add(sp.ReducedBody("bar", bar(), anchor="foot"))
    system.add(sp.FixedJoint("clamp", system.ground, body.point("foot")))
    system.start = "equilibrium"
    return system, body


def test_its_colours_are_the_strains_of_tension_and_bending() -> None:
    x, _, z = (bar().places[np.unique(bar().faces)] + (0.2, 0.0, 0.0)).T
    inner = (x > 0.1) & (x < 0.3)  # away from the rigid ends
    outer = inner & (np.abs(z) > 0.014)
    area, about_y = 0.02 * 0.03, 0.02 * 0.03**3 / 12
    push = sp.Force("push", strip()[1].point("tip"), x=-600.0)
    turn = sp.Torque("turn", strip()[1].point("tip"), y=1.0)
    bend = sp.Force("bend", strip()[1].point("tip"), z=2.0)
    cases = (
        (push, inner, np.full(len(x), 600.0 / (2e9 * area)), 0.01),
        (turn, inner, np.abs(z) / (2e9 * about_y), 0.01),
        (bend, outer, 2.0 * (0.4 - x) * np.abs(z) / (2e9 * about_y), 0.02),
    )
    for load, where, expected, error in cases:
        system, body = strip()
        system.add(replace(load, at=body.point("tip")))
        still = mb.simulate(system, 0.01, mb.GeneralizedAlpha(step=1e-3))
        scene = Animation.of(still.drawing()).scene
        (shape,) = (entry for entry in scene.primitives if entry.kind == "surface")
        assert shape.values.shape == shape.points.shape[:2]
        np.testing.assert_allclose(shape.values[0][where], expected[where], atol=error * expected[where].max())
        assert (scene.bar.title, scene.bar.highest) == ("largest principal strain", shape.values.max())
        ((_, mesh), *_) = vtk_motion(still, 1, 4)
        np.testing.assert_allclose(mesh.fields["strain"][-len(x) :], shape.values[0], rtol=1e-12)
        assert not mesh.fields["strain"][: -len(x)].any()
        assert [entry["values"] for entry in encoded(scene)["shapes"] if "values" in entry] == [len(shape.values)]


def test_one_bar_explains_colours_of_beams_and_reduced_bodies() -> None:
    system, body = strip()
    section = sp.Section.rectangle(0.03, 0.02, youngs_modulus=2e9, poisson_ratio=0.3, density=1200.0)
    rod = system.add(sp.Beam("rod", section, 0.4, 2, position=body.point("tip")))
    system.add(sp.FixedJoint("weld", body.point("tip"), rod.start))
    system.add(sp.Force("pull", rod.end, x=600.0))
    scene = Animation.of(mb.equilibrium(system).drawing()).scene
    shapes = {entry.name: entry.values[0] for entry in scene.primitives if entry.kind == "surface"}
    assert scene.bar.title == "strain"
    np.testing.assert_allclose(shapes["rod"], 5e-4, rtol=1e-2)
    assert np.median(shapes["bar"]) == pytest.approx(5e-4, rel=1e-2)


def test_a_body_without_a_mesh_of_solids_has_no_colours() -> None:
    system = sp.SpatialSystem()
    body = system.add(sp.ReducedBody("bar", replace(bar(), strains=None)))
    surface = body.skin(lower(system).x[None, : body.size])
    assert surface.strains is None
    scene = Animation.of(mb.simulate(system, 0.01, mb.GeneralizedAlpha(step=1e-3)).drawing()).scene
    assert scene.bar is None


def test_the_largest_principal_strain_is_the_largest_eigenvalue() -> None:
    strains = np.random.default_rng(1).standard_normal((200, 6))
    strains[0], strains[1, 3:], strains[2] = 0.0, 0.0, [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]
    matrices = strains[:, [[0, 5, 4], [5, 1, 3], [4, 3, 2]]]
    expected = np.abs(np.linalg.eigvalsh(matrices)).max(axis=1)
    np.testing.assert_allclose(largest_principal(strains), expected, atol=1e-12)


def test_a_fine_surface_is_drawn_by_few_corners() -> None:
    side = np.linspace(0.0, 1.0, 61)
    places = np.stack([*np.meshgrid(side, side, [0.0], indexing="ij")], axis=-1).reshape(-1, 3)
    corner = (61 * np.arange(60)[:, None] + np.arange(60)).ravel()
    faces = np.column_stack([corner, corner + 1, corner + 62, corner + 61])
    rows, triangles = coarse_surface(places, faces, 500)
    assert 100 < len(rows) <= 500
    a, b, c = places[rows][triangles].transpose(1, 0, 2)
    areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    assert areas.min() > 0.0
    assert areas.sum() == pytest.approx(1.0, rel=0.15)
    rows, triangles = coarse_surface(places, faces, 5000)
    assert (len(rows), len(triangles)) == (len(places), 2 * len(faces))


def codes(system: sp.SpatialSystem, end: float) -> list[str]:
    motion = mb.simulate(system, end, mb.GeneralizedAlpha(1e-3))
    return [finding.code for finding in motion.findings if finding.code.startswith("reduced")]


def test_findings_on_fast_spins_and_large_deformations() -> None:
    slow = 2 * np.pi * bar().clamped_frequency
    for rate, expected in ((0.05, []), (0.2, ["reduced-spin"])):
        system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
        system.add(sp.ReducedBody("bar", bar(), angular_velocity=(0.0, 0.0, rate * slow)))
        assert codes(system, 0.01) == expected
    system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
    body = system.add(sp.ReducedBody("bar", bar(), anchor="foot"))
    system.add(sp.FixedJoint("clamp", system.ground, body.point("foot")))
    system.add(sp.Force("push", body.point("tip"), z=300.0))
    motion = mb.simulate(system, 0.1, mb.GeneralizedAlpha(1e-3))
    (finding,) = (finding for finding in motion.findings if finding.code == "reduced-bending")
    assert (finding.values["body"], finding.severity) == ("bar", "warning")
    assert finding.values["angle"] > 10.0
    model = mb.TimeResponse(
        lambda force: system, {"force": (0.0, 1.0)}, ["bar.tip.z"], np.array([0.0, 0.1]), mb.GeneralizedAlpha(1e-3)
    )
    assert "reduced-bending" in [finding.code for finding in model.findings(np.array([0.5]))]


def test_a_sensor_reads_a_combination_of_the_displacements() -> None:
    structure = solid(box((0.4, 0.02, 0.03), (6, 2, 2)), Material(2e9, 0.3, 1200.0))
    ends = [structure.nodes.nearest((x, 0.01, 0.03)) for x in (0.1, 0.2)]
    row = np.zeros(structure.size)
    row[structure.dofs.index(f"{ends[0]}.z")] = 1.0
    gauge = strain_between(structure, *ends)
    stress = {dof: 2e11 * factor for dof, factor in gauge.items()}  # Pa
    recovery = {"gauge": gauge, "shift": row, "stress": stress}
    modes = free_body_modes(structure, {"foot": "left", "tip": "right"}, 6, recovery)
    system = sp.SpatialSystem()
    body = system.add(sp.ReducedBody("bar", modes, anchor="foot"))
    system.add(sp.SphericalJoint("ball", system.ground, body.point("foot")))
    for name in recovery:
        system.add(sp.RecoverySensor(name, body.point("tip"), name))
    motion = mb.simulate(system, 0.05, mb.GeneralizedAlpha(1e-4, spectral_radius=0.8))
    eta, rate = (array[:, body.size - modes.count : body.size] for array in (motion.states.x, motion.states.v))
    places = [modes.shapes[structure.nodes.rows([end])[0]] for end in ends]
    strain = (places[1] - places[0])[0] / 0.1
    np.testing.assert_allclose(motion.channels(["gauge.value"])[:, 0], eta @ strain, atol=1e-12)
    np.testing.assert_allclose(motion.channels(["gauge.rate"])[:, 0], rate @ strain, atol=1e-9)
    np.testing.assert_allclose(motion.channels(["shift.value"])[:, 0], eta @ places[0][2], atol=1e-12)
    np.testing.assert_allclose(motion.channels(["stress.value"])[:, 0], 2e11 * (eta @ strain), atol=0.1)
    assert np.abs(eta @ strain).max() > 1e-6
    rest = mb.equilibrium(system).channels(["gauge.value", "stress.value"])
    assert rest[1] == pytest.approx(2e11 * rest[0], rel=1e-9)


def test_messages_of_sensors() -> None:
    structure = solid(box((0.4, 0.02, 0.03), (2, 2, 2)), Material(2e9, 0.3, 1200.0))
    cases = [
        ({"gauge": np.zeros(3)}, "recovery 'gauge' has the shape \\(3,\\); expected"),
        ({"gauge": {"0.u": 1.0}}, "recovery 'gauge': unknown degree of freedom '0.u'"),
    ]
    for recovery, message in cases:
        with pytest.raises(InputError, match=message):
            free_body_modes(structure, {"foot": "left"}, 4, recovery)
    with pytest.raises(InputError, match="the nodes '0' and '0' are at one place"):
        strain_between(structure, "0", "0")
    body = sp.ReducedBody("bar", bar())
    with pytest.raises(InputError, match="unknown quantity 'gauge'"):
        sp.RecoverySensor("gauge", body.point("tip"), "gauge")
    rod = sp.RigidBody("rod", sp.Inertia.box(1.0, (0.1, 0.1, 0.1)))
    with pytest.raises(InputError, match="belongs to another body"):
        sp.RecoverySensor("gauge", rod.point("centre"), "gauge")


def test_messages() -> None:
    cases = [
        ({"points": {"tip": sp.NodePoint("tip")}}, "the point name 'tip' is that of a node. Choose another name"),
        ({"points": {"eye": sp.NodePoint("top")}}, "unknown interface node 'top'"),
        ({"anchor": "middle"}, "unknown anchor 'middle'"),
        ({"damping_ratio": -0.1}, "damping_ratio is -0.1"),
    ]
    for options, message in cases:
        with pytest.raises(InputError, match=message):
            sp.ReducedBody("bar", bar(), **options)
    with pytest.raises(InputError, match="an interface node is called 'centre'"):
        sp.ReducedBody("bar", replace(bar(), names=("foot", "centre")))
    with pytest.raises(InputError, match="modes is 3; expected FreeBodyModes, such as free_body_modes"):
        sp.ReducedBody("bar", 3)
