"""Campbell diagrams: modes followed over the speed, critical speeds, findings, files."""

import numpy as np
import pytest

from dalembert.structure import Campbell
from dalembert.structure.campbell import SpeedModes, followed
from dalembert.structure.complex_modes import complex_modes, whirl


def disc(speed: float, polar: float = 0.6, stiffness: float = 3e4) -> SpeedModes:
    """A rotor that tilts on isotropic springs: I = 1 about both axes across the shaft."""
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    found = complex_modes(np.eye(2), -polar * speed * turn, stiffness * np.eye(2))
    return SpeedModes(speed, found.roots, found.shapes, whirl(found.shapes, np.eye(2), turn), found.growth)


def diagram(speeds: np.ndarray, **changes: object) -> Campbell:
    modes = [disc(float(speed)) for speed in speeds]
    roots, ways = followed(modes, None)
    growth = np.array([own.growth for own in modes])
    given = {"unit": "rad/s", "values": speeds, "speeds": speeds, "roots": roots, "whirl": ways, "growth": growth}
    return Campbell(**{"parameter": "speed", "frame": "fixed", **given, **changes})


def test_modes_whirl_forward_and_backward_with_the_roots_of_a_gyroscope():
    found = disc(200.0)
    root = np.sqrt(120.0**2 + 4 * 3e4)
    np.testing.assert_allclose(found.roots.imag, [(root - 120.0) / 2, (root + 120.0) / 2], rtol=1e-12)
    np.testing.assert_allclose(found.whirl, [-1.0, 1.0], atol=1e-12)
    assert found.growth == 0.0


def test_whirl_along_a_line_is_zero_and_of_an_ellipse_between():
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    shapes = np.array([[1.0, 1.0, 1.0], [2.0, -0.5j, 0.5j]])
    np.testing.assert_allclose(whirl(shapes, np.eye(2), turn), [0.0, 0.8, -0.8], atol=1e-12)


def test_a_motion_that_grows_without_oscillation_has_a_growth_rate():
    found = complex_modes(np.eye(2), np.zeros((2, 2)), np.diag([4.0, -9.0]))
    assert found.growth == pytest.approx(3.0)
    np.testing.assert_allclose(found.roots, [2.0j], atol=1e-12)
    assert complex_modes(np.eye(1), np.zeros((1, 1)), np.zeros((1, 1))).growth == 0.0


def test_modes_that_cross_are_followed():
    # a mode of constant frequency along another coordinate is crossed by the backward mode of the disc
    def both(speed: float) -> SpeedModes:
        own = disc(speed)
        shapes = np.zeros((3, 3), dtype=complex)
        shapes[:2, :2], shapes[2, 2] = own.shapes, 1.0
        roots, ways = np.append(own.roots, 150.0j), np.append(own.whirl, 0.0)
        order = np.argsort(roots.imag)
        return SpeedModes(speed, roots[order], shapes[:, order], ways[order], 0.0)

    roots, ways = followed([both(speed) for speed in np.linspace(0.0, 300.0, 16)], None)
    constant = int(np.argmin(np.ptp(roots.imag, axis=0)))
    np.testing.assert_allclose(roots.imag[:, constant], 150.0)
    np.testing.assert_allclose(ways[:, constant], 0.0)
    assert np.all(np.diff(np.delete(roots.imag, constant, axis=1), axis=0)[1:, 0] < 0.0)


def test_critical_speeds_are_those_of_the_closed_form():
    speeds = np.linspace(0.0, 400.0, 21)
    found = diagram(speeds).critical_speeds
    assert [(own.mode, own.direction) for own in found] == [(1, "backward"), (2, "forward")]
    np.testing.assert_allclose([own.speed for own in found], np.sqrt(3e4 / np.array([1.6, 0.4])), rtol=1e-5)
    assert diagram(speeds, frame="rotating").critical_speeds == ()


def test_speeds_at_which_a_motion_grows_have_a_finding():
    growth = np.array([0.0, 0.5, 2.0])
    (finding,) = diagram(np.array([0.0, 100.0, 200.0]), growth=growth).findings
    assert (finding.code, finding.severity) == ("unstable-rotation", "warning")
    assert finding.values == {"speed": 100.0, "speeds": 2, "growth": 2.0}


def test_a_diagram_is_read_as_it_was_written(tmp_path):
    written = diagram(np.linspace(0.0, 100.0, 5))
    written.save(tmp_path / "campbell.nc")
    read = Campbell.load(tmp_path / "campbell.nc")
    for name in ("values", "speeds", "roots", "whirl", "growth"):
        np.testing.assert_array_equal(getattr(read, name), getattr(written, name))
    assert (read.parameter, read.unit, read.frame) == ("speed", "rad/s", "fixed")
    assert read.summary() == written.summary()
