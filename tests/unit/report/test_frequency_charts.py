"""Figures and tables of responses over frequency show the numbers of the curve."""

import xml.etree.ElementTree as ET
from base64 import b64decode
from dataclasses import replace

import numpy as np
import pytest

from dalembert.data import Measurements
from dalembert.errors import InputError
from dalembert.forward import Coordinate
from dalembert.inverse import identify
from dalembert.report import charts, figures, report
from dalembert.report.charts.frequency.contacts import COLOURS, STATES
from dalembert.report.pictures.colour_bar import graded, ticks
from dalembert.report.player.film import encoded
from dalembert.structure import Campbell, ReductionErrors, eigenmodes, mode_shapes
from dalembert.tables import prefixed
from dalembert.uncertainty import Vertex, propagate
from dalembert.vibration import (
    FrequencyResponse,
    HarmonicBalance,
    Newmark,
    backbone,
    compare_in_time,
    deformation,
    frequency_response,
    frequency_responses,
    steady_state,
    track_resonance,
)
from dalembert.vibration.paths.focus import Look, movers
from frequency_cases import damped, strip
from pages import read_page
from support import says
from vibrating_systems import chain, duffing, two_masses

HZ = 1 / (2 * np.pi)


@pytest.fixture(scope="module")
def curve():
    return frequency_response(two_masses(), HZ * np.linspace(0.7, 1.1, 17), HarmonicBalance(harmonics=5))


@pytest.fixture(scope="module")
def folded():
    return frequency_response(duffing(), (0.8 * HZ, 1.6 * HZ), HarmonicBalance(5), continuation="arc-length")


def traces(figure):
    return {trace.name: trace for trace in figure.data}


def test_the_curve_is_drawn_as_it_is(curve):
    figure = charts.frequency_curve(curve)
    drawn = traces(figure)
    assert set(drawn) == {"m1.x", "m2.x"}
    np.testing.assert_array_equal(drawn["m2.x"].x, curve.frequencies)
    np.testing.assert_array_equal(drawn["m2.x"].y, curve.amplitude("m2"))
    assert figure.layout.yaxis.title.text == "amplitude (m)"
    np.testing.assert_array_equal(
        traces(charts.frequency_curve(curve, ["m2.x"], kind="rms"))["m2.x"].y, curve.amplitude("m2", "rms")
    )
    with pytest.raises(InputError, match=says("unknown observed degree of freedom 'm3'; known: m1.x, m2.x")):
        charts.frequency_curve(curve, ["m3"])


def test_small_motions_are_drawn_in_small_units(curve):
    small = frequency_response(_pushed(1e-6), curve.frequencies, HarmonicBalance(3, samples=128))
    figure = charts.frequency_curve(small, ["m2.x"])
    assert figure.layout.yaxis.title.text == "amplitude (µm)"
    np.testing.assert_allclose(figure.data[0].y, 1e6 * small.amplitude("m2"))


def _pushed(force):
    system = two_masses()
    system.forces[0] = type(system.forces[0])("m1", force)
    return system


def test_folds_are_marked_and_both_branches_drawn(folded):
    drawn = traces(charts.frequency_curve(folded))
    np.testing.assert_array_equal(drawn["fold"].x, folded.folds)
    np.testing.assert_array_equal(drawn["fold"].y, folded.amplitude("m")[folded.fold])
    np.testing.assert_array_equal(drawn["m.x"].x, folded.frequencies)


def test_what_is_unstable_is_dashed():
    curve = frequency_response(
        duffing(), (0.8 * HZ, 1.6 * HZ), HarmonicBalance(5), continuation="arc-length", stability=True
    )
    drawn = traces(charts.frequency_curve(curve))
    sizes = curve.amplitude("m")
    dashed = drawn["m.x, unstable"]
    assert dashed.line.dash == "dash"
    np.testing.assert_array_equal(dashed.y[curve.stable == 0], sizes[curve.stable == 0])
    np.testing.assert_array_equal(drawn["m.x"].y, np.where(curve.stable == 0, np.nan, sizes))
    ends = np.flatnonzero(np.diff((curve.stable == 0).astype(int)))
    assert np.isfinite(dashed.y[ends]).all()  # the two meet


def test_the_loop_encloses_the_energy_of_a_period(curve):
    point = Look.of(curve, ["m2.x"]).point
    (loop,) = charts.hysteresis(curve, point).data
    assert loop.name == "slider.x"
    area = -np.sum((loop.y[1:] + loop.y[:-1]) / 2 * -np.diff(loop.x))
    assert area == pytest.approx(curve.dissipated("slider.x")[point], rel=1e-3)


def test_states_over_a_period_and_over_frequency(curve):
    point = Look.of(curve, ["m2.x"]).point
    states, *legend = charts.contact_states(curve, point).data
    assert [trace.name for trace in legend] == list(STATES)
    np.testing.assert_array_equal(states.z, curve.states[point])
    assert list(states.y) == ["slider"]
    shares = traces(charts.contact_shares(curve))
    assert set(shares) == {"stuck", "slipping"}
    np.testing.assert_allclose(shares["slipping"].y, 100 * (curve.states == 2).mean(axis=(1, 2)))


def test_energies_and_harmonics_over_frequency(curve):
    (energy,) = charts.dissipation(curve).data
    np.testing.assert_allclose(energy.y, curve.dissipated("slider.x"))
    drawn = traces(charts.harmonic_content(curve, "m2.x"))
    third = curve.amplitude("m2", "harmonic 3")
    np.testing.assert_allclose(drawn["harmonic 3"].y, np.where(third > 1e-9, third, np.nan))  # no gap while it slips
    assert "harmonic 2" not in drawn  # a symmetric motion has none


def test_the_page_has_the_numbers(curve, tmp_path):
    page = read_page(curve.report(tmp_path / "a.html", amplitude="harmonic 1"))
    row = next(row for row in page.table("peaks") if row[0] == "m2.x")
    peak = curve.peak("m2", "harmonic 1")
    assert (float(row[1]), float(row[2])) == (peak.amplitude, peak.frequency)
    (contact,) = page.table("contacts")[1:]
    point = Look.of(curve, ["m2.x"], "harmonic 1").point
    assert float(contact[4]) == curve.dissipated("slider.x")[point]
    assert sum(map(float, contact[1:4])) == pytest.approx(100.0)
    sizes = {row[0]: float(row[1]) for row in page.table("harmonics")[1:]}
    assert sizes["harmonic 1"] == pytest.approx(curve.amplitude("m2", "harmonic 1")[point], rel=1e-14)


def test_points_that_were_not_found_are_crossed_out_between_their_neighbours(tmp_path):
    method = HarmonicBalance(harmonics=5, samples=256, iterations=7, halvings=0)
    curve = frequency_response(chain(), HZ * np.linspace(1.0, 2.2, 25), method)
    lost = traces(charts.frequency_curve(curve, ["m3.x"]))["not found"]
    np.testing.assert_array_equal(lost.x, curve.frequencies[~curve.converged])
    assert np.isfinite(lost.y).all()
    page = read_page(report(curve, tmp_path / "a.html"))
    assert len(page.table("not-found")) - 1 == np.count_nonzero(~curve.converged)


def test_a_curve_of_which_nothing_was_found_has_its_diagnostics_alone():
    method = HarmonicBalance(harmonics=7, iterations=1, halvings=0)
    assert list(figures(frequency_response(chain(), HZ * np.linspace(1.0, 2.2, 5), method))) == ["points-found"]


def test_the_degree_of_freedom_that_moves_most_is_looked_at(curve):
    assert movers(curve) == ("m1.x", "m2.x")
    assert Look.of(curve).dof == max(curve.dofs, key=lambda dof: curve.amplitude(dof).max())


@pytest.fixture(scope="module")
def family():
    values = np.array([0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0])
    return frequency_responses(
        damped, "preload", values, (0.7 * HZ, 1.3 * HZ), HarmonicBalance(3, samples=256), unit="N"
    )


def test_a_family_shows_its_ends_its_best_and_the_envelope(family):
    drawn = traces(charts.curve_family(family, "m2.x"))
    named = [trace.name for trace in charts.curve_family(family, "m2.x").data if trace.showlegend is not False]
    assert named == ["0 N", "4 N, smallest peak", "12 N", "smallest of all", "largest of all"]
    np.testing.assert_array_equal(drawn["4 N, smallest peak"].y, family.curves[4].amplitude("m2"))
    envelope = family.envelope("m2")
    np.testing.assert_array_equal(drawn["smallest of all"].y, envelope.smallest)
    np.testing.assert_array_equal(drawn["largest of all"].x, envelope.frequencies)


def test_peaks_over_the_parameter(family, tmp_path):
    drawn = traces(charts.family_peaks(family, "m2.x"))
    peaks = family.peaks("m2")
    np.testing.assert_array_equal(drawn["peak"].x, family.values)
    np.testing.assert_array_equal(drawn["peak"].y, [peak.amplitude for peak in peaks])
    np.testing.assert_array_equal(drawn["its frequency"].y, [peak.frequency for peak in peaks])
    assert list(drawn["smallest, at 4 N"].x) == [family.best("m2")]
    rows = read_page(family.report(tmp_path / "a.html")).table("family-1")[1:]
    assert [float(row[1]) for row in rows] == [peak.amplitude for peak in peaks]
    np.testing.assert_allclose([float(row[3]) for row in rows], -100 * family.reduction("m2"))


def test_points_in_time_lie_beside_the_curve(curve, tmp_path):
    compared = compare_in_time(two_masses(), curve, points=[4, 8], method=Newmark(steps_per_period=128))
    drawn = traces(charts.time_comparison(compared, curve))
    column = compared.dofs.index("m2.x")
    np.testing.assert_array_equal(drawn["m2.x"].y, curve.amplitude("m2"))
    np.testing.assert_array_equal(drawn["m2.x, in time"].y, compared.time[:, column])
    np.testing.assert_array_equal(drawn["m2.x, harmonic balance"].y, curve.amplitude("m2")[[4, 8]])
    rows = read_page(report(curve, tmp_path / "a.html", compared)).table("in-time")
    own = [row for row in rows if row[1] == "m2.x"]
    np.testing.assert_allclose([float(row[4]) for row in own], 100 * compared.differences[:, column])


def test_a_nonlinear_mode_lies_on_the_curve_and_alone(folded, tmp_path):
    mode = backbone(duffing(), np.array([0.5, 1.0, 2.0]), method=HarmonicBalance(3))
    line = traces(charts.frequency_curve(folded, mode=mode))["m.x, mode 1 without force"]
    np.testing.assert_array_equal(line.x, mode.frequencies)
    np.testing.assert_array_equal(line.y, mode.amplitude("m"))
    frequency, damping = charts.backbone(mode).data
    np.testing.assert_array_equal(frequency.y, mode.frequencies)
    np.testing.assert_array_equal(damping.y, 100 * mode.damping)
    rows = read_page(mode.report(tmp_path / "a.html")).table("backbone")[1:]
    np.testing.assert_array_equal([float(row[4]) for row in rows], mode.forces)


def test_a_resonance_over_a_parameter(tmp_path):
    method = HarmonicBalance(3, samples=256)
    track = track_resonance(damped, "preload", [12.0, 10.0, 8.0], (0.7 * HZ, 1.4 * HZ), method, dof="m2.x", unit="N")
    drawn = traces(charts.resonance_track(track))
    np.testing.assert_array_equal(drawn["peak"].y, track.amplitudes)
    np.testing.assert_array_equal(drawn["its frequency"].y, track.frequencies)
    assert list(drawn["smallest, at 8 N"].y) == [track.amplitudes.min()]
    rows = read_page(track.report(tmp_path / "a.html")).table("resonance")
    assert rows[0] == ["preload (N)", "peak (m)", "at frequency (Hz)", "points balanced"]


@pytest.fixture(scope="module")
def shape():
    system = strip()
    method = HarmonicBalance(harmonics=3, samples=256)
    return deformation(system, frequency_response(system, np.linspace(60.0, 90.0, 7), method))


def test_the_deformed_shape_goes_through_its_period(shape):
    scene = charts.deformation(shape).scene
    rest, body = scene.primitives
    assert (rest.kind, rest.role, body.kind) == ("edges", "outline", "mesh")
    assert len(scene.times) == len(body.points) == len(scene.film.labels) == 24
    deflections = np.abs(shape.motion(2 * np.pi * np.arange(24) / 24)).max(axis=(1, 2))
    assert scene.film.labels[0] == f"{15 * deflections.argmax()}"  # it begins with the largest deflection
    motion = shape.motion(np.array([np.deg2rad(float(scene.film.labels[12]))]))[0]
    largest = np.linalg.norm(shape.motion(2 * np.pi * np.arange(24) / 24), axis=2).max(axis=0)
    factor = 0.1 * np.linalg.norm(np.ptp(shape.places, axis=0)) / largest.max()
    np.testing.assert_allclose(body.points[12], shape.places + factor * motion, atol=1e-12)
    np.testing.assert_array_equal(body.faces, shape.faces)
    np.testing.assert_allclose(body.values[0], prefixed(largest.max(), "m")[0] * largest, rtol=1e-12)
    assert scene.bar.highest == body.values.max()
    assert scene.film.endless


def test_a_shape_is_printed_in_the_colours_of_its_bar(shape):
    animation = charts.deformation(shape)
    picture = ET.fromstring(animation.svg)
    fills = {part.get("fill") for part in picture.iter("{http://www.w3.org/2000/svg}path")}
    body = animation.scene.primitives[1]
    mean = body.values[0][body.faces].mean(axis=1) / animation.scene.bar.highest
    assert set(graded(mean)) <= fills
    words = [text.text for text in picture.iter("{http://www.w3.org/2000/svg}text")]
    assert words == [text for _, text in ticks(animation.scene.bar)] + [animation.scene.bar.title]


def test_a_browser_gets_colours_and_labels_of_a_shape(shape):
    scene = charts.deformation(shape).scene
    film = encoded(scene, complete=True)
    assert film["frames"][0] == f"phase {scene.film.labels[0]} °"
    assert (film["quantity"], film["endless"], film["seconds"]) == ("phase", True, 2.0)
    numbers = np.frombuffer(b64decode(film["positions"]), "<f4")
    np.testing.assert_array_equal(numbers[-len(shape.places) :], scene.primitives[1].values[0].astype("f4"))
    assert [item.get("values") for item in film["shapes"]] == [None, 1]


def test_nodes_without_faces_are_coloured_points(shape):
    scene = charts.deformation(replace(shape, faces=np.zeros((0, 3), dtype=int))).scene
    (points,) = scene.primitives
    assert points.kind == "points"
    assert points.values.shape == (1, len(shape.places))


def test_the_interface_map_shows_the_state_of_each_phase(shape):
    figure = charts.interface_map(shape)
    colours = np.array([COLOURS[state] for state in STATES])
    (contacts,) = (trace for trace in figure.data if trace.text is not None)
    np.testing.assert_allclose(contacts.x, shape.contact_places[:, 0])
    assert list(contacts.marker.color) == list(colours[shape.states[:, 0]])
    assert list(figure.frames[8].data[0].marker.color) == list(colours[shape.states[:, 16]])
    assert figure.layout.xaxis.title.text == "x (m)"


def test_a_campbell_diagram_has_modes_rotation_and_critical_speeds():
    speeds = np.arange(5.0)
    roots = 1j * (2.0 + np.outer(speeds, [-0.3, 0.4, 0.0]))
    whirl = np.tile([-1.0, 1.0, 0.0], (5, 1))
    diagram = Campbell("speed", "rad/s", speeds, speeds, roots, whirl, np.zeros(5), "fixed")
    figure = charts.campbell(diagram)
    assert [trace.name for trace in figure.data] == [
        "mode 1, backward", "mode 2, forward", "mode 3", "rotation", "critical speed",
    ]  # fmt: skip
    assert [trace.line.dash for trace in figure.data[:3]] == ["dash", "solid", "dot"]
    np.testing.assert_allclose(figure.data[1].y, roots[:, 1].imag / (2 * np.pi))
    np.testing.assert_allclose(figure.data[4].x, [2.0 / 1.3, 2.0, 2.0 / 0.6])
    assert figure.layout.yaxis.title.text == "frequency in the fixed frame (Hz)"
    rotating = charts.campbell(replace(diagram, frame="rotating"))
    assert [trace.name for trace in rotating.data] == ["mode 1, backward", "mode 2, forward", "mode 3"]


def test_modes_are_drawn_one_after_another():
    structure = strip().structure
    modes = mode_shapes(structure, eigenmodes(structure, 3))
    scene = charts.mode_shapes(modes).scene
    assert len(scene.times) == 3
    assert scene.film.labels[0] == f"1: {modes.frequencies[0]:.6g} Hz"
    assert not scene.film.endless
    np.testing.assert_allclose(scene.primitives[1].values[1], np.linalg.norm(modes.shapes[1], axis=1), rtol=1e-12)


def test_a_fit_over_frequency_has_its_labels(tmp_path):
    model = FrequencyResponse(damped, {"preload": (1.0, 6.0)}, ["m2 peak", "m1 rms"], HZ * np.linspace(0.8, 1.1, 13))
    truth = model.evaluate(np.array([3.0])).values[0]
    data = Measurements.of(
        Coordinate("frequency", "Hz", model.frequencies), {"m2 peak": truth[:, 0], "m1 rms": truth[:, 1]}
    )
    fit = identify(model, data, starts=1, start=[2.5])
    found = figures(fit)
    first, second = found["responses-1"], found["responses-2"]
    assert first.layout.yaxis.title.text == "amplitude (m)"
    assert first.layout.yaxis2.title.text == "residual (m)"
    assert second.layout.yaxis.title.text == "rms (m)"
    assert first.layout.xaxis2.title.text == "frequency (Hz)"
    assert read_page(fit.report(tmp_path / "a.html")).table("responses")[0][0] == "frequency (Hz)"
    band = figures(propagate(model, {"preload": (2.9, 3.1)}, Vertex()))["bands-1"]
    assert (band.layout.yaxis.title.text, band.layout.xaxis2.title.text) == ("amplitude (m)", "frequency (Hz)")


def test_a_period_in_time_is_drawn_as_it_is():
    motion = steady_state(two_masses(), 0.9 * HZ, Newmark(steps_per_period=128))
    drawn = traces(charts.periodic_motion(motion))
    np.testing.assert_array_equal(drawn["m2.x"].y, motion.motion("m2"))
    np.testing.assert_allclose(drawn["m2.x"].x, 360 * np.arange(128) / 128)
    (loop,) = charts.loops_in_time(motion).data
    np.testing.assert_array_equal(loop.y[:-1], motion.forces[:, 0])
    assert (loop.x[0], loop.y[0]) == (loop.x[-1], loop.y[-1])


def test_errors_of_a_reduction_are_in_percent():
    errors = ReductionErrors(np.array([10.0, 20.0]), np.array([10.1, 20.0]), np.array([0.99, 1.0]))
    frequency, similarity = charts.reduction_errors(errors).data
    np.testing.assert_allclose(frequency.y, [1.0, np.nan])
    np.testing.assert_allclose(similarity.y, [0.01, np.nan])


def test_folds_are_tabled_by_the_amplitude_that_is_drawn(folded, tmp_path):
    rows = read_page(folded.report(tmp_path / "a.html", amplitude="harmonic 1")).table("marked-points")
    assert rows[0][2] == "amplitude of harmonic 1 of m.x (m)"
    np.testing.assert_array_equal([float(row[2]) for row in rows[1:]], folded.amplitude("m", "harmonic 1")[folded.fold])


def test_a_family_takes_what_is_known_beside_it(family):
    mode = backbone(duffing(), np.array([0.5, 1.0]), method=HarmonicBalance(3))
    assert list(figures(family, mode))[-1] == "backbone"
