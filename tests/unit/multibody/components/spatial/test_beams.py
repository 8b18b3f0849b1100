"""Beams in space: their sections, shapes, markers and drawings, and messages for input that cannot work."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import dalembert.multibody as mb
import dalembert.multibody.spatial as sp
from dalembert.errors import InputError
from dalembert.export.mechanism import motion as vtk_motion
from dalembert.multibody.components.spatial.beam_element import BEAMS
from dalembert.multibody.components.spatial.beam_kinematics import frames, lines, strains
from dalembert.multibody.components.spatial.beam_shapes import Places, rule
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.model.evaluate import energies, residual
from dalembert.multibody.model.lowering import lower
from dalembert.report import Animation
from spatial_scenes import BEAM, beam
from support import says

STEEL = {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3, "density": 7850.0}
ROD = sp.Section.circle(0.01, **STEEL)


def test_sections_have_the_constants_of_their_shapes():
    e, g = STEEL["youngs_modulus"], STEEL["youngs_modulus"] / 2.6
    circle = np.diagonal(ROD.matrix)
    assert circle[0] == pytest.approx(e * np.pi * 1e-4)
    assert circle[3] == pytest.approx(g * np.pi * 1e-8 / 2)
    tube = np.diagonal(sp.Section.tube(0.01, 0.008, **STEEL).matrix)
    assert tube[4] == pytest.approx(e * np.pi / 4 * (1e-8 - 0.008**4))
    rectangle = np.diagonal(sp.Section.rectangle(0.02, 0.01, **STEEL).matrix)
    assert rectangle[4] == pytest.approx(e * 0.02 * 0.01**3 / 12)  # bending about y: z is the height
    assert rectangle[3] == pytest.approx(g * 0.228688 * 0.02 * 0.01**3, rel=1e-4)  # Timoshenko and Goodier, table
    solid = sp.Section.box(0.02, 0.01, 0.004999, **STEEL)
    assert solid.matrix[5, 5] == pytest.approx(rectangle[5], rel=1e-3)
    i_beam = sp.Section.i_beam(0.1, 0.2, 0.006, 0.009, **STEEL)
    area = 2 * 0.1 * 0.009 + 0.182 * 0.006
    assert i_beam.mass == pytest.approx(7850 * area)
    assert i_beam.matrix[4, 4] > 5 * i_beam.matrix[5, 5]


def test_offsets_couple_strains_and_keep_the_energy():
    own = (100.0, 40.0, 30.0, 2.0, 3.0, 5.0)
    section = sp.Section(own, 1.0, (0.1, 0.2), centroid=(0.02, -0.03), shear_centre=(0.01, 0.04))
    e = np.array([0.1, -0.2, 0.3, 0.5, -0.7, 0.4])
    stretch = e[0] + -0.03 * e[4] - 0.02 * e[5]
    shears = e[1] - 0.04 * e[3], e[2] + 0.01 * e[3]
    energy = own @ np.square([stretch, *shears, *e[3:]])
    assert e @ section.matrix @ e == pytest.approx(energy)
    moved = sp.Section(own, 2.0, (0.1, 0.2), 0.05, centre=(0.3, -0.1)).pseudo_inertia
    np.testing.assert_allclose(moved, [[2.0, 0.6, -0.2], [0.6, 0.38, -0.01], [-0.2, -0.01, 0.12]])


@pytest.mark.parametrize("degree", [1, 2, 3, 4])
def test_a_rigid_motion_strains_nothing(degree):
    whip = sp.Beam("whip", ROD, 1.0, 1, degree, curvature=(0.5, -1.0, 2.0))
    nodes = whip.placed(whip.frame((0.0, 0.0, 0.0))).reshape(-1, 4, 3)
    turn = Rotation.from_rotvec([0.7, -1.2, 2.0]).as_matrix()
    moved = nodes @ turn.T
    moved[:, 0] += (3.0, -2.0, 1.0)
    at = Places.at(degree, np.array(rule(degree, degree).places))
    first, second = (strains(own, at, np.array(1.0)) for own in (nodes, moved))
    np.testing.assert_allclose(first, second, atol=2e-14)
    np.testing.assert_allclose(first, np.tile([1.0, 0.0, 0.0, 0.5, -1.0, 2.0], (degree, 1)), atol=1e-13)
    np.testing.assert_allclose(frames(moved, at), frames(nodes, at) @ turn.T, atol=1e-14)


@pytest.mark.slow
@pytest.mark.parametrize("degree", [1, 2, 3, 4])
def test_forces_are_the_gradient_of_the_energy_in_all_coordinates(degree):
    build = beam(degree)
    own = lower(build(**BEAM | {"damping": 0.0, "mass_damping": 0.0}))
    noise = np.random.default_rng(degree).normal(size=len(own.x))
    x, still, n = own.x + 0.1 * noise, np.zeros_like(own.x), own.structure.n
    x[n:] = 0.0
    forces = residual(own, own.real, x, still, still, only=BEAMS[degree - 1])[:n]
    times, slopes = np.zeros(1), np.zeros(n)
    for i in range(n):
        moved = x + 0j
        moved[i] += 1j * STEP
        slopes[i] = energies(own.complex_model, moved[None], still[None] + 0j, times, times)[0, 1].imag / STEP
    np.testing.assert_allclose(forces, slopes, atol=1e-13 * np.abs(slopes).max())


@pytest.mark.slow
@pytest.mark.parametrize("degree", [1, 3, 4])
def test_energy_is_balanced_at_each_degree(degree):
    motion = mb.simulate(beam(degree)(**BEAM), 0.2, mb.RadauIIA(tolerance=1e-9))
    assert np.abs(motion.energies["balance"]).max() < 1e-4 * motion.energies["kinetic"].max()
    assert motion.violations["position"].max() < 1e-12


def test_shapes_without_stress():
    circle = sp.Beam("arc", ROD, np.pi, 4, 2, curvature=(0.0, 0.0, 1.0))
    shape = circle.placed(circle.frame((0.0, 0.0, 0.0))).reshape(-1, 4, 3)
    np.testing.assert_allclose(shape[-1, 0], [0.0, 2.0, 0.0], atol=2e-3)  # half a circle of radius one
    poses = [sp.Pose(tuple(node[0]), sp.Orientation.of(node[1:].T)) for node in shape]
    placed = sp.Beam("arc", ROD, np.pi, 4, 2, nodes=poses)
    np.testing.assert_allclose(placed._references, circle._references, atol=1e-10)
    changing = sp.Beam("spring", ROD, 1.0, 2, 3, curvature=lambda s: (s, 0.0, 1.0))
    assert changing._references[1, 2, 3] == pytest.approx(0.5 + 0.5 * rule(3, 3).places[2])
    still = lower(_clamped(circle))
    np.testing.assert_allclose(
        residual(still, still.real, still.x, 0 * still.x, 0 * still.x)[: still.structure.n], 0.0, atol=1e-4
    )


def _clamped(whip: sp.Beam) -> sp.SpatialSystem:
    system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
    system.add(whip)
    system.add(sp.FixedJoint("clamp", system.ground, whip.start))
    return system


def test_a_shape_without_load_is_an_equilibrium():
    rest = mb.equilibrium(_clamped(sp.Beam("arc", ROD, 1.0, 2, 2, curvature=(0.5, 0.2, 1.0))))
    start = lower(rest.system).x
    n = rest.lowered.structure.n
    np.testing.assert_allclose(rest.x[:n], start[:n], atol=1e-12)


def test_a_section_that_changes_is_interpolated():
    thick = sp.Section.circle(0.02, **STEEL)
    taper = sp.Beam("taper", [(0.0, thick), (0.4, ROD), (1.0, ROD)], 1.0, 1, 1)
    at = rule(1, 1).places[0]
    assert at == 0.5
    np.testing.assert_allclose(taper.section_at(0.5).matrix, ROD.matrix)
    np.testing.assert_allclose(taper.section_at(0.1).matrix, 0.75 * thick.matrix + 0.25 * ROD.matrix)
    mass = lower(_clamped(taper)).data[BEAMS[0]][0, BEAMS[0].columns(("mass_1",))[0]]
    assert thick.mass > mass > ROD.mass


def test_points_stand_off_the_line():
    corner = sp.NodePoint("end", (0.0, 0.1, 0.0), sp.Orientation.by_angles("z", np.pi / 2))
    whip = sp.Beam("whip", ROD, 1.0, 1, points={"corner": corner}, position=(1.0, 2.0, 3.0))
    system = _clamped(whip)
    other = system.add(sp.Beam("other", ROD, 0.5, 1, position=whip.point("corner")))
    system.add(sp.FixedJoint("weld", whip.point("corner"), other.start))
    tip = mb.equilibrium(system).channels(["other.end.x", "other.end.y", "other.end.z"])
    np.testing.assert_allclose(tip, [2.0, 2.6, 3.0], atol=1e-12)
    assert whip.point_names == ("start", "end", "node0", "node1", "node2", "corner")


def test_a_bent_beam_is_drawn_along_its_line():
    whip = sp.Beam("arc", ROD, np.pi, 3, 3, curvature=(0.0, 0.0, 1.0))
    own = whip.placed(whip.frame((0.0, 0.0, 0.0)))
    drawn = whip.outline(own[None], 8)[0]
    assert len(drawn) == 3 * 8 + 1
    np.testing.assert_allclose(np.linalg.norm(drawn - [0.0, 1.0, 0.0], axis=1), 1.0, atol=1e-3)
    nodes = own.reshape(-1, 4, 3)
    np.testing.assert_allclose(lines(nodes[:4], Places.at(3, np.array([0.0, 1.0]))), nodes[[0, 3], 0], atol=1e-14)


def test_a_beam_is_drawn_by_the_outline_of_its_section():
    strip = sp.Beam("strip", sp.Section.rectangle(0.2, 0.1, **STEEL), 1.0, 2, 2)
    at = strip.placed(strip.frame((0.0, 0.0, 0.0)))
    skin = strip.skin(at[None])
    corners = skin.corners[0].reshape(-1, 4, 3)
    np.testing.assert_allclose(
        corners[:, :, 1:], np.tile([[0.1, 0.05], [-0.1, 0.05], [-0.1, -0.05], [0.1, -0.05]], (17, 1, 1))
    )
    np.testing.assert_allclose(corners[:, 0, 0], np.linspace(0.0, 1.0, 17), atol=1e-14)
    assert len(skin.triangles) == 16 * 4 * 2 + 2 * 2
    assert sp.Beam("bare", sp.Section((1.0,) * 6, 1.0, (1.0, 1.0)), 1.0).skin(at[None]) is None
    wide, thin = (sp.Section.circle(radius, **STEEL) for radius in (0.1, 0.05))
    taper = sp.Beam("taper", [(0.0, wide), (1.0, thin)], 1.0, 2, 2).skin(at[None]).corners[0].reshape(-1, 10, 3)
    np.testing.assert_allclose(np.linalg.norm(taper[:, :, 1:], axis=2)[:, 0], np.linspace(0.1, 0.05, 17))
    motion = mb.simulate(_clamped(strip), 0.01, mb.GeneralizedAlpha(step=1e-3))
    (shape,) = (entry for entry in Animation.of(motion.drawing()).scene.primitives if entry.kind == "surface")
    assert shape.points.shape[1:] == (68, 3)


def test_a_beam_is_coloured_by_its_strain_along_the_line():
    section = sp.Section.rectangle(0.02, 0.01, **STEEL)
    system = _clamped(sp.Beam("strip", section, 1.0, 2, 3, prestrain=(1e-3, 0.0, 0.0, 0.0, 0.0, 0.0)))
    strip = system.bodies[0]
    system.add(sp.Force("pull", strip.end, y=2.0, z=3.0))
    system.start = "equilibrium"
    still = mb.simulate(system, 0.01, mb.GeneralizedAlpha(step=1e-3))
    (shape,) = (entry for entry in Animation.of(still.drawing()).scene.primitives if entry.kind == "surface")
    strains = shape.values[0].reshape(17, 4)  # rings, corners (y, z)
    e = STEEL["youngs_modulus"]
    about_y, about_z = 3.0 / (e * section.moments[0] / 7850.0), 2.0 / (e * section.moments[1] / 7850.0)
    corner = np.abs(-0.005 * about_y - 0.01 * about_z)  # at the clamp, (y, z) = (0.01, 0.005) m
    np.testing.assert_allclose(strains[:, 0], corner * np.linspace(1.0, 0.0, 17), atol=2e-3 * corner)
    assert strains.max() == pytest.approx(Animation.of(still.drawing()).scene.bar.highest, rel=1e-6)
    ((_, mesh), *_) = vtk_motion(still, 1, 4)
    np.testing.assert_allclose(mesh.fields["strain"][-68:], strains.ravel())
    assert not mesh.fields["strain"][:-68].any()


def test_section_forces_are_those_of_the_clamp():
    whip = sp.Beam("whip", sp.Section.rectangle(0.02, 0.01, **STEEL), 1.0, 2, 3, curvature=(0.1, 0.5, 1.0))
    system = sp.SpatialSystem()
    system.add(whip)
    system.add(sp.FixedJoint("clamp", system.ground, whip.start))
    system.add(sp.Force("pull", whip.end, 30.0, -20.0, 10.0))
    for name, point in (("first", whip.start), ("middle", whip.node(3)), ("last", whip.end)):
        system.add(sp.BeamSensor(name, point, gauge=(0.01, -0.004)))
    axes = [f"{what}_{k}" for what in ("force", "torque") for k in (1, 2, 3)]
    outputs = [f"{what}_{k}" for what in ("force", "moment") for k in (1, 2, 3)]
    motion = mb.simulate(system, 0.05, mb.GeneralizedAlpha(step=1e-3))
    clamp = motion.channels([f"clamp.{name}" for name in axes])
    section = motion.channels([f"first.{name}" for name in outputs])
    np.testing.assert_allclose(section, -clamp, atol=1e-9 * np.abs(clamp).max())
    rest = mb.equilibrium(system)
    last = rest.channels([f"last.{name}" for name in outputs])
    turn = rest.channels(["whip.end.q0", "whip.end.q1", "whip.end.q2", "whip.end.q3"])
    pulled = Rotation.from_quat(np.roll(turn, -1)).inv().apply([30.0, -20.0, 10.0])
    np.testing.assert_allclose(last, [*pulled, 0.0, 0.0, 0.0], atol=1e-8)
    strains = rest.channels([f"middle.{name}" for name in ("stretch", "bend_y", "bend_z")])
    forces = rest.channels([f"middle.{name}" for name in ("force_1", "moment_2", "moment_3")])
    np.testing.assert_allclose(strains, forces / np.diagonal(whip.section.matrix)[[0, 4, 5]], rtol=1e-12)
    at_gauge = rest.channels(["middle.strain"])[0]
    assert at_gauge == pytest.approx(strains[0] - 0.004 * strains[1] - 0.01 * strains[2])


def test_forces_along_a_line_are_its_weight_and_turn_with_it():
    system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
    whip = system.add(sp.Beam("whip", ROD, 0.2, 2, 2, orientation=sp.Orientation.by_angles("y", 0.5)))
    system.add(sp.FixedJoint("clamp", system.ground.point((0.0, 0.0, 0.0), whip.orientation), whip.start))
    system.add(sp.LineForce("push", whip.end, 1.0, 2.0, 3.0))
    system.add(sp.LineForce("wind", whip.end, z=5.0, follower=True))
    system.add(sp.BeamSensor("gauge", whip.start))
    rest = mb.equilibrium(system)
    held = rest.channels([f"clamp.force_{axis}" for axis in "xyz"])
    outputs = [
        [f"{owner}_{k}" for k in (1, 2, 3)] for owner in ("gauge.moment", "clamp.torque", "gauge.force", "clamp.force")
    ]
    moment, torque, section, clamp = map(rest.channels, outputs)
    np.testing.assert_allclose(moment, -torque, atol=1e-9)
    np.testing.assert_allclose(section, -clamp, atol=1e-9)
    turned = whip.orientation.matrix @ [0.0, 0.0, 5.0]
    np.testing.assert_allclose(held, -0.2 * (np.array([1.0, 2.0, 3.0]) + turned), rtol=1e-4)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: sp.Section((1.0, 1.0, 1.0, -2.0, 1.0, 1.0), 1.0, (1.0, 1.0)),
            "Section: the stiffness against twist is -2; expected a positive number",
        ),
        (
            lambda: sp.Section(
                [[2.0, 0, 0, 0, 0, 3.0], *np.eye(6)[1:5].tolist(), [3.0, 0, 0, 0, 0, 2.0]], 1.0, (1.0, 1.0)
            ),
            "Section: the stiffness matrix is not positive definite. No energy is stored by -0.5 stretch, 0.5 bending about z. Check the entries beside the diagonal",
        ),
        (
            lambda: sp.Section(np.eye(6)[:3], 1.0, (1.0, 1.0)),
            "Section: the stiffness is a ndarray; expected six finite numbers, or a matrix (6, 6): E A, k_y G A, k_z G A "
            "in N, G J, E I_y, E I_z in N m^2",
        ),
        (
            lambda: sp.Section(np.triu(np.ones((6, 6))), 1.0, (1.0, 1.0)),
            "Section: the stiffness is a ndarray; expected a symmetric matrix (6, 6)",
        ),
        (
            lambda: sp.Section((1.0,) * 6, 1.0, (1.0, 1.0), 2.0),
            "Section: the product of the mass is 2 kg m; expected less than the root of the product of the moments, 1 kg m",
        ),
        (
            lambda: sp.Section.tube(0.01, 0.02, **STEEL),
            "Section.tube: inner is 0.02 m and radius 0.01 m; expected a smaller inner radius",
        ),
        (
            lambda: sp.Section.rectangle(0.0, 0.02, **STEEL),
            "Section.rectangle: width is 0.0; expected a positive number in m",
        ),
        (
            lambda: sp.Section.box(0.1, 0.1, 0.06, **STEEL),
            "Section.box: wall is 0.06 m; expected less than half of 0.1 m and 0.1 m",
        ),
        (
            lambda: sp.Section.i_beam(0.1, 0.1, 0.2, 0.01, **STEEL),
            "Section.i_beam: web is 0.2 m and flange 0.01 m; expected less than the width, 0.1 m, and half of the height, 0.1 m",
        ),
        (lambda: sp.Beam("b", ROD, 1.0, 0), "beam 'b': elements is 0; expected a whole number, from 1 to 100000"),
        (lambda: sp.Beam("b", ROD, 1.0, 1, 5), "beam 'b': degree is 5; expected 1, 2, 3 or 4"),
        (
            lambda: sp.Beam("b", ROD, 1.0, 1, 1, curvature=(0.0, 0.0, 3.2)),
            "beam 'b': a node turns by 180 degrees or more against the middle of its element; use more elements",
        ),
        (
            lambda: sp.Beam("b", [(0.0, ROD), (0.5, ROD)], 1.0),
            "beam 'b': the places of its sections are [0.0, 0.5]; expected increasing ones from 0 to the length, 1 m",
        ),
        (
            lambda: sp.Beam("b", 3.0, 1.0),
            f"beam 'b': section is 3.0; expected {sp.Section.IN_WORDS}, or two or more of (place, Section)",
        ),
        (
            lambda: sp.Beam("b", ROD, 1.0, nodes=[sp.Pose()]),
            "beam 'b': 1 nodes were given; expected a Pose for each of its 3 nodes, elements x degree + 1",
        ),
        (
            lambda: sp.Beam("b", ROD, 1.0, points={"end": sp.NodePoint()}),
            "beam 'b': the point name 'end' is that of a node. Choose another name",
        ),
        (
            lambda: sp.Beam("b", ROD, 1.0, points={"p": sp.NodePoint("node7")}),
            "beam 'b', point 'p': unknown node 'node7'; did you mean 'node2' or 'node1'?",
        ),
        (
            lambda: sp.BeamSensor("g", sp.Beam("b", ROD, 1.0, 2).node(1)),
            "BeamSensor 'g': b.node1 is inside an element; expected an end of an element: node0, node2, node4, …",
        ),
        (
            lambda: sp.BeamSensor("g", sp.PointMass("m", 1.0).point("centre")),
            "BeamSensor 'g': m.centre belongs to another body than a beam. Give a point of a Beam",
        ),
        (
            lambda: sp.LineForce("w", sp.PointMass("m", 1.0).point("centre")),
            "LineForce 'w': m.centre belongs to another body than a beam. Give a point of a Beam",
        ),
        (
            lambda: sp.Section((1.0,) * 6, 1.0, (1.0, 1.0), outline=[(0.0, 1.0)]),
            "Section: outline is [(0.0, 1.0)]; expected three or more corners (y, z) in m, or none",
        ),
    ],
)
def test_what_cannot_work_is_refused(make, message):
    with pytest.raises(InputError, match=says(message)):
        make()


@pytest.mark.parametrize(("elements", "codes"), [(1, ["beam-turn"]), (3, [])])
def test_nodes_that_turn_far_in_a_motion_are_a_finding(elements, codes):
    bent = sp.Beam("bent", ROD, 1.0, elements, 2, curvature=(0.0, 0.0, 3.6))
    motion = mb.simulate(_clamped(bent), 0.002, mb.GeneralizedAlpha(step=1e-3))
    findings = [finding for finding in motion.findings if finding.code == "beam-turn"]
    assert [finding.code for finding in findings] == codes
    for finding in findings:
        assert finding.values["angle"] == pytest.approx(np.degrees(1.8), abs=2.0)
