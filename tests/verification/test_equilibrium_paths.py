"""Paths of equilibria: limit points and buckling loads beside closed forms and published values."""

import numpy as np
import pytest

import dalembert.multibody as mb
import dalembert.multibody.spatial as sp
from flat_arch import flat_arch

TOPIC = "Equilibria along a load"
FREE = (0.0, 0.0, 0.0)


def section(torsion: float, about_y: float, about_z: float, stretch: float = 1e6) -> sp.Section:
    """A section by its stiffnesses; its inertia does not matter in statics."""
    return sp.Section((stretch, stretch, stretch, torsion, about_y, about_z), 1.0, (1.0, 1.0))


def critical(build, start: float, end: float) -> tuple[list[str], list[float]]:
    """Kinds and loads of the critical points of a path."""
    points = mb.equilibrium_path(build, start, end).critical
    return [point.kind for point in points], [point.load for point in points]


def test_a_flat_arch_of_two_springs_snaps_through(record_evidence) -> None:
    # F = 2 k (L0 - L) y / L with L^2 = 1 + y^2 is largest where L^3 = L0.
    longest, length = 1.01**0.5, 1.01 ** (1 / 6)
    load = 2e4 * (longest - length) * np.sqrt(length**2 - 1) / length
    path = mb.equilibrium_path(flat_arch, 0.0, 10.0)
    assert [point.kind for point in path.critical] == ["limit", "limit"]
    record_evidence(
        "Limit loads of a flat arch of two springs", [load, -load], [point.load for point in path.critical], unit="N",
        tolerance=1e-7, topic=TOPIC, kind="closed form", source="derivative of the force by the height",
    )  # fmt: skip
    y = path.channels(["apex.centre.y"])[:, 0]
    long = np.sqrt(1 + y**2)
    np.testing.assert_allclose(2e4 * (longest - long) * y / long, path.loads, atol=1e-8)
    assert path.loads[-1] == 10.0
    np.testing.assert_array_equal(path.stable, np.abs(y) > np.sqrt(length**2 - 1))


SUPPORTS = {"clamped, free": 0.25, "hinged, hinged": 1.0, "clamped, hinged": 2.0457483, "clamped, clamped": 4.0}
"""Buckling loads over pi^2 E I / L^2: Euler's cases."""


def column(case: str):
    """A column along x, pushed at its end; it may buckle along z alone."""

    def build(load: float) -> sp.SpatialSystem:
        system = sp.SpatialSystem(gravity=FREE)
        beam = system.add(sp.Beam("b", section(1e3, 1.0, 1e3, 1e7), 1.0, elements=8, degree=3))
        clamped, axis = not case.startswith("hinged"), (0.0, 1.0, 0.0)
        foot = sp.FixedJoint("foot", system.ground, beam.start) if clamped else (
            sp.RevoluteJoint("foot", system.ground, beam.start, axis=axis)
        )  # fmt: skip
        system.add(foot)
        head = system.ground.point((1.0, 0.0, 0.0))
        if case.endswith("clamped"):
            system.add(sp.PrismaticJoint("head", head, beam.end, axis=(1.0, 0.0, 0.0)))
        elif case.endswith("hinged"):
            system.add(sp.PointOnLineJoint("head", head, beam.end, axis=(1.0, 0.0, 0.0)))
        system.add(sp.Force("push", beam.end, x=-load))
        return system

    return build


@pytest.mark.parametrize("case", SUPPORTS)
def test_columns_buckle_at_eulers_loads(record_evidence, case: str) -> None:
    load = SUPPORTS[case] * np.pi**2
    kinds, loads = critical(column(case), 0.0, 1.1 * load)
    assert kinds == ["branch"]
    record_evidence(
        f"Column, {case}: buckling load", load, loads[0], unit="N", tolerance=2e-5, relative=True, topic=TOPIC,
        kind="closed form", source="Euler",
    )  # fmt: skip


def test_a_strip_on_edge_buckles_sideways(record_evidence) -> None:
    def build(load: float) -> sp.SpatialSystem:
        system = sp.SpatialSystem(gravity=FREE)
        strip = system.add(sp.Beam("b", section(1.0, 2.0, 2e4, 1e7), 1.0, elements=4, degree=3))
        system.add(sp.FixedJoint("clamp", system.ground, strip.start))
        system.add(sp.Force("push", strip.end, y=-load))
        return system

    kinds, loads = critical(build, 0.0, 6.0)
    assert kinds == ["branch"]
    record_evidence(
        "Strip on edge with a force at its end: lateral buckling load", 4.0126 * 2.0**0.5, loads[0], unit="N",
        tolerance=1e-4, relative=True, topic=TOPIC, kind="closed form", source="Prandtl 1899: 4.0126 sqrt(E I G J) / L^2",
    )  # fmt: skip


def frame(load: float) -> sp.SpatialSystem:
    """A frame of two legs at a right angle with a force in its plane (Argyris and others 1979), in N and mm."""
    modulus, ratio, thick, wide = 71240.0, 0.31, 0.6, 30.0
    shear, area = modulus / (2 * (1 + ratio)), thick * wide
    torsion = shear * wide * thick**3 / 3 * (1 - 0.63 * thick / wide)
    bending = modulus * wide * thick**3 / 12, modulus * thick * wide**3 / 12
    stiffness = modulus * area, 5 / 6 * shear * area, 5 / 6 * shear * area, torsion, *bending
    own, turn = sp.Section(stiffness, 1.0, (1.0, 1.0)), sp.Orientation.by_angles("z", -np.pi / 2)
    system = sp.SpatialSystem(gravity=FREE)
    corner = {"corner": sp.NodePoint("end", (0.0, 0.0, 0.0), turn)}
    first = system.add(sp.Beam("first", own, 240.0, elements=4, degree=3, points=corner))
    second = system.add(sp.Beam("second", own, 240.0, elements=4, degree=3, position=first.point("corner")))
    system.add(sp.FixedJoint("clamp", system.ground, first.start))
    system.add(sp.FixedJoint("corner", first.point("corner"), second.start))
    system.add(sp.Force("push", second.end, x=load))
    return system


def test_a_right_angle_frame_buckles_out_of_its_plane(record_evidence) -> None:
    kinds, loads = critical(frame, 0.0, 1.5)
    assert kinds == ["branch"]
    common = {"unit": "N", "topic": TOPIC}
    record_evidence(
        "Right-angle frame: buckling load", 1.0841, loads[0], tolerance=1e-4, kind="other method",
        source="beam elements of degree 2, ten a leg, path of load steps", **common,
    )  # fmt: skip
    record_evidence(
        "Right-angle frame: buckling load", 1.088, loads[0], tolerance=5e-3, kind="published",
        source="Simo and Vu-Quoc 1986", **common,
    )  # fmt: skip


@pytest.mark.slow
def test_an_arch_passes_its_limit_point(record_evidence) -> None:
    # An arch of 215 degrees, clamped at one end and hinged at the other, pushed down at its apex.
    radius, angle = 100.0, np.radians(215.0)

    def build(load: float) -> sp.SpatialSystem:
        system = sp.SpatialSystem(gravity=FREE)
        tilt = sp.Orientation.by_angles("z", angle / 2)
        arch = system.add(
            sp.Beam("b", section(1e9, 1e9, 1e6, 1e8), radius * angle, elements=8, degree=3, orientation=tilt,
                    curvature=(0.0, 0.0, -1 / radius))
        )  # fmt: skip
        system.add(sp.FixedJoint("clamp", system.ground.point((0.0, 0.0, 0.0), tilt), arch.start))
        system.add(sp.RevoluteJoint("hinge", system.ground, arch.end, axis=(0.0, 0.0, 1.0)))
        system.add(sp.Force("push", arch.node(12), y=-load))
        return system

    (point,) = mb.equilibrium_path(build, 0.0, 1000.0, most_points=90).critical
    assert point.kind == "limit"
    record_evidence(
        "Arch of 215°, clamped and hinged: limit load", 897.0, point.load, unit="N", tolerance=4.0, topic=TOPIC,
        kind="published", source="DaDeppo and Schmidt 1975, inextensible arch",
    )  # fmt: skip
