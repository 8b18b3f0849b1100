"""Structures in study files: what is built from their tables, their tasks, and every sentence about what cannot be."""

import json
import re

import numpy as np
import pytest
from scipy.io import mmwrite
from scipy.sparse import coo_array

from dalembert.data import Measurements
from dalembert.errors import DalembertError, InputError
from dalembert.structure import Modal, eigenmodes, lumped
from dalembert.study import load, plan, report_run, run_study
from dalembert.study.run.validation import forecast
from dalembert.study.tasks.assessments import foreseen
from dalembert.vibration import (
    Deformation,
    ElasticSlider,
    FrequencyCurve,
    FrequencyResponse,
    FrictionContact,
    HarmonicBalance,
    HarmonicForce,
    VibrationSystem,
    frequency_response,
)
from support import says

PARAMETERS = """
[parameters]
mu = { lower = 0.0, upper = 1.0, start = 0.3 }
preload = { lower = "0 N", upper = "5 N", start = "2 N" }
[constants]
k = "1 N/m"
"""
MODEL = """
[model]
[[model.mass]]
name = "m1"
mass = "1 kg"
[[model.mass]]
name = "m2"
mass = "1000 g"
[[model.spring]]
first = "m1"
stiffness = "k"
damping = 0.02
[[model.spring]]
first = "m1"
second = "m2"
stiffness = "k"
damping = 0.02
[[model.spring]]
first = "m2"
stiffness = "0.5*k"
damping = 0.01
[[model.force]]
dof = "m1"
amplitude = "1 N"
[[model.contact]]
name = "slider"
first = "m2"
friction = "mu"
preload = "preload"
law = { kind = "ElasticSlider", tangential_stiffness = "1.5 N/m" }
[harmonic_balance]
harmonics = 5
samples = 256
"""
CURVE = """
[frequency_response]
frequencies = { start = 0.12, end = 0.16, count = 5 }
"""
WHOLE = PARAMETERS + MODEL + CURVE
IMPORTED = """
[model.structure]
files = { mass = "m.mtx", stiffness = "k.mtx" }
sets = { ends = ["1", "3"] }
fixed = ["1"]
damping = { kind = "Modal", ratio = 0.01 }
reduction = { modes = 0, masters = ["ends"] }
[[model.force]]
dof = "3"
amplitude = 1.0
[frequency_response]
frequencies = [0.1]
"""
FUNCTIONS = """
from dalembert.structure import lumped
from dalembert.vibration import HarmonicForce, VibrationSystem

def structure(stiffness):
    return lumped({"m": 1.0}, [("m", None, stiffness, 0.1)])

def plate():
    from dalembert.structure import Material, plate
    return plate((0.4, 0.4), 2e-3, Material(210e9, 0.3, 7800.0), (4, 4)).fixed("edge")

def system(mu, stiffness):
    made = VibrationSystem(structure(stiffness))
    made.add(HarmonicForce("m", 1.0 + mu))
    return made
"""


def two_masses(mu: float = 0.3, preload: float = 2.0) -> VibrationSystem:
    springs = [("m1", None, 1.0, 0.02), ("m1", "m2", 1.0, 0.02), ("m2", None, 0.5, 0.01)]
    system = VibrationSystem(lumped({"m1": 1.0, "m2": 1.0}, springs))
    system.add(HarmonicForce("m1", 1.0))
    system.add(FrictionContact("slider", "m2", friction=mu, preload=preload, law=ElasticSlider(1.5)))
    return system


@pytest.fixture
def write(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "made.py").write_text(FUNCTIONS)
    stiffness = np.array([[2.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]])
    mmwrite(tmp_path / "m.mtx", coo_array(np.eye(3)))
    mmwrite(tmp_path / "k.mtx", coo_array(stiffness))
    mmwrite(tmp_path / "small.mtx", coo_array(np.eye(2)))

    def write(text):
        path = tmp_path / "study.toml"
        path.write_text(text)
        return path

    return write


def test_a_structure_of_tables_is_the_one_of_calls(write, tmp_path):
    study = load(write(WHOLE))
    assert plan(study) == "follows the response from 0.12 to 0.16 Hz (5 points, 5 harmonics): 1 simulation"
    assert re.search(r": 5 simulations of .* \(a point, going by both ends of the curve\)\.$", next(forecast(study)))
    folder, outcome = run_study(study, tmp_path / "run")
    ours = FrequencyCurve.load(folder.result)
    theirs = frequency_response(two_masses(), np.linspace(0.12, 0.16, 5), HarmonicBalance(5, samples=256))
    np.testing.assert_array_equal(ours.response, theirs.response)
    peak = theirs.peak("m1")
    assert outcome.best == {"values": {"peak of m1.x": peak.amplitude, "frequency (Hz)": peak.frequency}}
    first = folder.report.read_text()
    folder.report.unlink()
    report_run(folder)
    assert folder.report.read_text() == first


def test_a_study_chooses_its_harmonics(write, tmp_path):
    text = WHOLE.replace("harmonics = 5\nsamples = 256", 'harmonics = "auto"') + 'amplitude = "harmonic 2"\n'
    study = load(write(text))
    assert plan(study) == (
        "follows the response from 0.12 to 0.16 Hz (5 points, 5 to 127 harmonics, chosen by the truncation error): "
        "1 simulation"
    )
    folder, outcome = run_study(study, tmp_path / "run")
    (chosen,) = outcome.findings
    theirs = frequency_response(two_masses(), np.linspace(0.12, 0.16, 5), HarmonicBalance("auto", least_harmonics=5))
    assert (chosen.code, chosen.values["harmonics"]) == ("harmonics-chosen", theirs.orders[-1])
    np.testing.assert_array_equal(FrequencyCurve.load(folder.result).response, theirs.response)
    assert chosen.message in folder.report.read_text()
    events = map(json.loads, (folder.path / "events.jsonl").read_text().splitlines())
    assert {event["harmonics"] for event in events if event["event"] == "followed"} == {5, theirs.orders[-1]}


def test_a_look_ahead_says_the_harmonics_of_a_model():
    frequencies = np.linspace(0.12, 0.16, 5)
    model = FrequencyResponse(two_masses, {"mu": (0.2, 0.4)}, ["m2 peak"], frequencies, HarmonicBalance("auto"))
    data = Measurements(frequencies, ("m2 peak",), model.evaluate(np.array([[0.3]])).values[0])
    assert any("harmonics were chosen" in sentence for sentence in foreseen(model, data))


def test_kinds_of_springs_forces_and_laws(write):
    more = """
[[model.spring]]
kind = "CubicSpring"
name = "hard"
first = "m1"
second = "m2"
stiffness = "2 N/mm^3"
[[model.spring]]
kind = "Gap"
name = "stop"
first = "m1"
stiffness = 3.0
gap = "1 mm"
[[model.force]]
kind = "StaticForce"
dof = "m1"
value = "2*mu"
[[model.contact]]
name = "second"
first = "m1"
second = "m2"
friction = 0.1
preload = 1.0
law = { kind = "Iwan", stiffnesses = [1.0, "2*k"], shares = [0.25, 0.75] }
[[model.contact]]
name = "third"
first = "m1"
friction = 0.1
law = { kind = "Rigid", prediction = "velocity" }
[harmonic_balance]
"""
    system = load(write(WHOLE.replace("[harmonic_balance]\n", more))).system()
    hard, stop, slider, second, third = system.elements
    assert (hard.stiffness, hard.second, stop.gap, stop.second) == (2e9, "m2", 1e-3, None)
    assert [force.__class__.__name__ for force in system.forces] == ["HarmonicForce", "StaticForce"]
    assert system.forces[1].value == 0.6
    assert (slider.law.tangential_stiffness, second.law.stiffnesses, third.law.prediction) == (
        1.5,
        (1.0, 2.0),
        "velocity",
    )


def test_a_mass_may_move_along_several_axes(write):
    text = WHOLE.replace('mass = "1 kg"', 'mass = "1 kg"\ndirections = ["x", "y"]').replace(
        'first = "m1"', 'first = "m1.x"'
    )
    text = text.replace('dof = "m1"', 'dof = "m1.x"')
    assert load(write(text)).system().structure.dofs.names == ("m1.x", "m1.y", "m2.x")


LOSSY = WHOLE.replace('stiffness = "k"\n', 'stiffness = "k"\nloss_factor = "0.1*mu"\n', 1)


def test_springs_and_matrices_have_loss_factors(write):
    assert load(write(WHOLE)).system().structure.loss is None
    np.testing.assert_allclose(load(write(LOSSY)).system().structure.loss, [[0.03, 0.0], [0.0, 0.0]])
    text = "[model]\n" + IMPORTED.replace("damping =", "loss_factor = 0.02\ndamping =", 1)
    structure = load(write(text)).system().structure
    np.testing.assert_allclose(structure.loss, 0.02 * structure.stiffness)


def test_a_loss_factor_of_matrices_needs_these(write):
    text = WHOLE.replace("[model]\n", "[model]\n[model.structure]\nloss_factor = 0.02\n", 1)
    with pytest.raises(InputError, match=r"loss_factor: there are no matrices here for it; give springs a loss_factor"):
        load(write(text))


def test_hysteretic_damping_carries_a_curve_and_not_its_stability(write, tmp_path):
    folder, _ = run_study(load(write(LOSSY)), tmp_path / "run")
    springs = [("m1", None, 1.0, 0.02, 0.03), ("m1", "m2", 1.0, 0.02), ("m2", None, 0.5, 0.01)]
    system = VibrationSystem(lumped({"m1": 1.0, "m2": 1.0}, springs))
    system.add(HarmonicForce("m1", 1.0))
    system.add(FrictionContact("slider", "m2", friction=0.3, preload=2.0, law=ElasticSlider(1.5)))
    theirs = frequency_response(system, np.linspace(0.12, 0.16, 5), HarmonicBalance(5, samples=256))
    np.testing.assert_array_equal(FrequencyCurve.load(folder.result).response, theirs.response)
    for key, line in (
        ("stability", "stability = true\n"),
        ("compare_in_time", "compare_in_time = { frequencies = [0.12] }\n"),
    ):
        with pytest.raises(InputError, match=rf"\[frequency_response\], {key}: the structure has hysteretic damping"):
            plan(load(write(LOSSY + line)))
    nonlinear = LOSSY.replace(CURVE, '[backbone]\nbetween = ["0.1 m", "1 m"]\n')
    with pytest.raises(InputError, match=r"\[backbone\]: the structure has hysteretic damping"):
        plan(load(write(nonlinear)))


STOPPED = """
[model]
[[model.mass]]
name = "m"
mass = "1 kg"
[[model.spring]]
first = "m"
stiffness = "1 N/m"
damping = "0.1 N*s/m"
[[model.spring]]
kind = "Gap"
name = "stop"
first = "m"
stiffness = "4 N/m"
[[model.force]]
dof = "m"
amplitude = "1 N"
[harmonic_balance]
harmonics = 5
[frequency_response]
between = ["0.34 Hz", "0.4 Hz"]
continuation = "arc-length"
"""


def test_branches_are_kept_and_drawn_with_their_curve(write, tmp_path):
    text = STOPPED + "stability = true\nbranches = true\nisolated = [0.36]\n"
    folder, outcome = run_study(load(write(text)), tmp_path / "run")
    assert list(outcome.further_results) == ["branch_1"]
    branch = FrequencyCurve.load(folder.result.with_name("branch_1.nc"))
    assert branch.provenance["method"]["periods"] == 2
    report_run(folder)
    assert "Branch 1 lies between" in (tmp_path / "run" / "report.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            STOPPED + "branches = true\n",
            "branches: they begin at markers; give stability = true and continuation = 'arc-length'",
        ),
        (
            STOPPED.replace('between = ["0.34 Hz", "0.4 Hz"]\ncontinuation = "arc-length"', "frequencies = [0.35]")
            + "isolated = [0.36]\n",
            "isolated: the range of its branches is missing; give between = [begin, end]",
        ),
        (STOPPED + "isolated = [0.5]\n", "isolated: 0.5 Hz lies outside between; expected frequencies inside"),
    ],
)
def test_branches_need_a_path(write, text, message):
    with pytest.raises(InputError, match=re.escape(message)):
        load(write(text))


def test_damping_stands_beside_dampers(write):
    text = WHOLE.replace(
        "[model]\n", '[model]\n[model.structure]\ndamping = { kind = "Rayleigh", stiffness = "0.1*mu" }\n', 1
    )
    structure = load(write(text)).system().structure
    own = np.array([[0.04, -0.02], [-0.02, 0.03]])
    np.testing.assert_allclose(structure.damping, own + 0.03 * structure.stiffness)


def test_matrices_of_files_are_clamped_damped_and_reduced(write):
    study = load(write(IMPORTED))
    structure = study.system().structure
    assert structure.dofs.names == ("3.x",)
    stiffness, mass = 0.5, 1.25  # statically, the free node moves half as much as the end
    np.testing.assert_allclose([structure.stiffness[0, 0], structure.mass[0, 0]], [stiffness, mass])
    np.testing.assert_allclose(structure.damping, 2 * 0.01 * np.sqrt(stiffness * mass))
    assert study.builder.full().size == 2
    assert structure.with_damping(Modal(0.01)).damping == pytest.approx(structure.damping)


def test_a_structure_or_a_system_may_come_from_a_function(write):
    text = '[model.structure]\nfunction = "made.py:structure"\narguments = { stiffness = 4.0 }\n'
    force = '[[model.force]]\ndof = "m"\namplitude = 1.0\n'
    study = load(write(text + force + "[frequency_response]\nfrequencies = [0.1]\n"))
    assert study.system().structure.stiffness.tolist() == [[4.0]]
    text = PARAMETERS + '[model]\nfunction = "made.py:system"\narguments = { stiffness = 4.0 }\n'
    text = text.replace('preload = { lower = "0 N", upper = "5 N", start = "2 N" }\n', "")
    study = load(write(text + "[frequency_response]\nfrequencies = [0.1]\n"))
    assert study.system().forces[0].amplitude == 1.3
    study = load(write(text + '[harmonic_balance]\n[propagate]\nfrequencies = [0.1]\nchannels = ["m peak"]\n'))
    assert study.forward(["m peak"], np.array([0.1])).coordinate.unit == "Hz"


def test_friction_is_identified_from_a_curve_and_bounds_it(write, tmp_path):
    along = np.linspace(0.11, 0.18, 8)
    curve = frequency_response(two_masses(0.25, 2.0), along, HarmonicBalance(5, samples=256))
    rows = [f"{f * 1e3!r},{x!r}" for f, x in zip(along.tolist(), curve.amplitude("m2").tolist(), strict=True)]
    (tmp_path / "curve.csv").write_text("\n".join(["f,x", *rows]))
    one = PARAMETERS.replace('preload = { lower = "0 N", upper = "5 N", start = "2 N" }\n', "").replace(
        'k = "1 N/m"', 'k = "1 N/m"\npreload = "2 N"'
    )
    data = '[data]\nfile = "curve.csv"\nfrequency = "f"\nunits = { f = "mHz" }\ncolumns = { "m2 peak" = "x" }\n'
    _, outcome = run_study(load(write(one + MODEL + data + "[identify]\nstarts = 1\n")), tmp_path / "fit")
    assert outcome.best["values"]["mu"] == pytest.approx(0.25, rel=1e-6)
    task = '[propagate]\nfrequencies = [0.14]\nchannels = ["m2 peak"]\nintervals.mu = [0.2, 0.3]\nmethod = "vertex"\n'
    _, outcome = run_study(load(write(one + MODEL + task)), tmp_path / "bounds")
    ends = [
        frequency_response(two_masses(mu), np.array([0.14]), HarmonicBalance(5, samples=256)).amplitude("m2")[0]
        for mu in (0.2, 0.3)
    ]
    assert [outcome.result.lower[0, 0], outcome.result.upper[0, 0]] == pytest.approx(sorted(ends))


@pytest.mark.parametrize(
    ("task", "told", "numbers"),
    [
        (
            '[track_resonance]\nparameter = "preload"\nvalues = [2.0, 3.0]\nbetween = [0.1, 0.2]\ndof = "m2"\n',
            "follows the peak of m2 (peak) over 2 values of preload, 2 to 3: 2 simulations",
            {"preload", "peak of m2.x", "frequency (Hz)"},
        ),
        (
            "[backbone]\namplitudes = [0.5, 1.0, 2.0]\n",
            "follows mode 1 from 0.5 to 2 m (3 amplitudes): 1 simulation",
            {"frequency at first", "frequency at last", "largest damping"},
        ),
        (
            "[backbone]\nbetween = [0.5, 1.0]\nmode = 2\n",
            "follows mode 2 from 0.5 to 1 m (as many amplitudes as it needs): 1 simulation",
            {"frequency at first", "frequency at last", "largest damping"},
        ),
        (
            CURVE
            + "backbone = { amplitudes = [0.5, 1.0] }\ncompare_in_time = { frequencies = [0.13], way = 'shooting', "
            "method = { steps_per_period = 64 } }\n",
            "follows the response from 0.12 to 0.16 Hz (5 points, 5 harmonics): 1 simulation",
            {"peak of m1.x", "frequency (Hz)"},
        ),
        (
            CURVE + 'sweep = { parameter = "preload", values = { count = 3 } }\ndof = "m2"\namplitude = "rms"\n',
            "follows the response from 0.12 to 0.16 Hz (5 points, 5 harmonics) for 3 values of preload: 3 simulations",
            {"preload", "rms of m2", "frequency (Hz)", "reduction"},
        ),
    ],
)
def test_each_task_runs_and_its_report_is_made_anew(write, tmp_path, task, told, numbers):
    study = load(write(PARAMETERS + MODEL + task))
    assert plan(study) == told
    assert next(forecast(study))
    folder, outcome = run_study(study, tmp_path / "run")
    assert outcome.success
    assert set(outcome.best["values"]) == numbers
    first = folder.report.read_text()
    folder.report.unlink()
    report_run(folder)
    assert folder.report.read_text() == first


def test_modes_and_motion_of_a_structure_with_nodes_are_drawn(write, tmp_path):
    text = '[model.structure]\nfunction = "made.py:plate"\ndamping = { kind = "Modal", ratio = 0.01 }\n'
    study = load(write(text + "[modes]\ncount = 3\n"))
    assert plan(study) == "finds the lowest 3 of 36 modes: 1 simulation"
    folder, outcome = run_study(study, tmp_path / "modes")
    square = study.system().structure
    assert outcome.best["values"]["mode 1"] == pytest.approx(eigenmodes(square, 1).frequencies[0])
    middle = square.nodes.nearest((0.2, 0.2))
    force = f'[[model.force]]\ndof = "{middle}.z"\namplitude = 1.0\n'
    along = f'frequencies = [100.0, 110.0, 120.0]\nobserve = ["{middle}"]\ndof = "{middle}.z"\n'
    folder, _ = run_study(load(write(text + force + "[frequency_response]\n" + along)), tmp_path / "curve")
    assert Deformation.load(folder.path / "deformation.nc").frequency in (100.0, 110.0, 120.0)
    first = folder.report.read_text()
    report_run(folder)
    assert folder.report.read_text() == first
    folder, _ = run_study(
        load(write(text + force + "[frequency_response]\ndeformed = false\n" + along)), tmp_path / "plain"
    )
    assert not (folder.path / "deformation.nc").exists()


def test_a_point_that_is_not_found_is_marked_and_the_curve_goes_on(write, tmp_path):
    text = WHOLE.replace("samples = 256", "samples = 256\niterations = 3\nhalvings = 0")
    folder, outcome = run_study(load(write(text)), tmp_path / "run")
    curve = FrequencyCurve.load(folder.result)
    lost = ~curve.converged
    assert 0 < lost.sum() < 5
    assert not outcome.success
    status = (
        f"{lost.sum()} of 5 points between 0.12 and 0.16 Hz were not found; they are marked, and the curve continues "
        "past them."
    )
    assert outcome.status == folder.state()["message"] == status
    assert "residual" in outcome.summary
    assert folder.report.is_file()


def test_a_structure_that_nothing_holds_is_refused(write, tmp_path):
    text = """
[[model.mass]]
name = "m"
mass = 1.0
[[model.force]]
kind = "StaticForce"
dof = "m"
value = 1.0
[frequency_response]
frequencies = [1.0]
"""
    sentence = (
        "[[model.spring]]: a mean force of 1 N acts along 'm.x', where no spring and no contact holds the structure, "
        "so it has no periodic motion; clamp it, or balance the static forces"
    )
    assert refused(write, text) == sentence
    with pytest.raises(DalembertError, match=re.escape(sentence)):
        run_study(load(write(text)), tmp_path / "run")


def refused(write, text) -> str:
    """The one sentence about what is wrong, from reading or from the plan."""
    with pytest.raises(DalembertError) as error:
        plan(load(write(text)))
    return str(error.value)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (
            ('"mu"\npreload', '"mu - 1"\npreload'),
            "[[model.contact]] 'slider': friction is -0.7; expected zero or a positive number",
        ),
        (
            ('first = "m2"\nfriction', 'first = "m3"\nfriction'),
            "[model]: contact 'slider': unknown degree of freedom 'm3.x'; did you mean 'm2.x' or 'm1.x'?",
        ),
        (('dof = "m1"', 'dof = "m"'), "[model]: a force: unknown degree of freedom 'm'; known: m1.x, m2.x"),
        (
            ('second = "m2"\nstiffness', 'second = "m4"\nstiffness'),
            "[[model.spring]]: spring 2: unknown degree of freedom 'm4'; known: m1.x, m2.x",
        ),
        (
            ("samples = 256", "samples = 8"),
            "study.toml: [harmonic_balance]: HarmonicBalance: samples is 8, too few for 5 harmonics. Use at "
            "least 11",
        ),
        (
            ('name = "m2"\nmass = "1000 g"', 'name = "m1"\nmass = 2.0'),
            "study.toml: [model]: 2 masses are called 'm1'; expected different names",
        ),
        (
            ("[harmonic_balance]", "[solver]\nstep = 1e-3\n[harmonic_balance]"),
            "study.toml: [solver] integrates mechanisms; a structure over frequency takes [harmonic_balance], or "
            "neither",
        ),
        (
            (CURVE, "[simulate]\nend = 1.0\n"),
            "study.toml: [simulate] needs a mechanism, and there is a structure; its task is [frequency_response]",
        ),
        (
            (CURVE, '[propagate]\ntimes = [1.0]\nchannels = ["m1 peak"]\n'),
            "study.toml: [propagate]: the key 'frequencies' is missing; a structure needs it\n"
            "study.toml: [propagate], times: the response of a structure lies along frequencies; leave the key out",
        ),
        (
            ("frequencies = {", 'continuation = "arc-length"\nfrequencies = {'),
            "study.toml: [frequency_response]: continuation: a path by arc length finds its own frequencies; give "
            "between = [begin, end]",
        ),
        (
            ("start = 0.12", "start = 0"),
            "study.toml: [frequency_response]: the frequency 0 Hz was given; expected positive ones",
        ),
        (
            ("frequencies = {", "between = [0.1, 0.1]\nfrequencies = {"),
            "study.toml: [frequency_response]: frequencies and between are both given; expected one of them\n"
            "study.toml: [frequency_response]: between: 0.1 Hz was given twice; expected two different frequencies",
        ),
        (
            ("frequencies = {", 'sweep = { parameter = "preloud", values = [1.0] }\nfrequencies = {'),
            "study.toml: [frequency_response], sweep: unknown parameter 'preloud'; did you mean 'preload'?",
        ),
        (
            (CURVE, "[backbone]\nbetween = [0.0, 1.0]\n"),
            "study.toml: [backbone]: the amplitude 0 m was given; expected positive ones",
        ),
        (
            (CURVE, "[modes]\n"),
            "[modes] draws the shapes, and the structure does not say where its nodes are; the function that "
            "[model.structure] or [model] names must return a structure with nodes=Nodes(...)",
        ),
        (
            (CURVE, "[backbone]\n"),
            "study.toml: [backbone]: neither amplitudes nor between is given; expected one of them",
        ),
        (
            (CURVE, CURVE + 'compare_in_time = {}\nsweep = { parameter = "preload", values = [1.0] }\n'),
            "study.toml: [frequency_response], compare_in_time: it belongs to one curve, and sweep makes several; "
            "leave one of them out",
        ),
        (
            ("frequencies = {", 'dof = "m3"\nfrequencies = {'),
            "[frequency_response], dof: unknown observed degree of freedom 'm3'; known: m1.x, m2.x",
        ),
        (
            ("frequencies = {", 'amplitude = "harmonic 9"\nfrequencies = {'),
            "[frequency_response], amplitude: the kind of amplitude is 'harmonic 9'; expected 'peak', 'rms', or "
            "'harmonic K' with K among the harmonics kept: 0, 1, 2, 3, 4, 5",
        ),
        (
            ('"1.5 N/m" }', '"1.5 N/m" }\n[[model.body]]\nkind = "PointMass"\nname = "b"\nmass = 1.0'),
            "study.toml: [model]: body and mass are given; expected either the [[model.body]] tables of a mechanism, "
            "or the [[model.mass]] tables or the [model.structure] of a structure, or function = 'model.py:name', or "
            "forward = 'model.py:name'",
        ),
        (
            ("[model]\n", '[model]\ngravity = [0, -9.81]\n'),
            "study.toml: [model]: joint, load, gravity, driving, start, pose and rates belong to a model of "
            "[[model.body]] tables; this is a structure",
        ),
        (
            ("[model]\n", "[model]\n[model.structure]\nfixed = ['m1']\n"),
            "study.toml: [model.structure]: fixed: there are no matrices here for it; give file, files or function",
        ),
        (
            ("[model]\n", "[model]\n[model.structure]\nfile = 'm.mtx'\n"),
            "study.toml: [[model.mass]] and the matrices of [model.structure] are both given; expected one of "
            "them",
        ),
    ],
)  # fmt: skip
def test_what_does_not_fit_together_is_told(write, change, sentence):
    assert WHOLE.count(change[0]) == 1
    assert refused(write, WHOLE.replace(*change)) == sentence


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (
            ('"m.mtx"', '"small.mtx"'),
            "[model.structure]: Structure: the stiffness matrix has shape (3, 3); expected (2, 2), a row for each of "
            "the 2 degrees of freedom",
        ),
        (
            ('files = { mass = "m.mtx", stiffness', "files = { stifness"),
            "study.toml: [model.structure]: files: unknown matrix 'stifness'; did you mean 'stiffness'?\n"
            "study.toml: [model.structure]: files: expected one for the mass and one for the stiffness",
        ),
        (
            ('mass = "m.mtx"', 'mass = "n.mtx"'),
            "study.toml: [model.structure.files], mass: 'n.mtx' was given, but there is no file {folder}/n.mtx",
        ),
        (
            (
                'files = { mass = "m.mtx", stiffness = "k.mtx" }',
                'function = "made.py:system"\narguments = { mu = 0.1, stiffness = 1.0 }',
            ),
            "[model.structure]: made.py:system returned a VibrationSystem; expected a Structure",
        ),
    ],
)
def test_what_is_wrong_with_matrices_is_told(write, tmp_path, change, sentence):
    assert IMPORTED.count(change[0]) == 1
    assert refused(write, IMPORTED.replace(*change)) == sentence.format(folder=tmp_path)


def test_a_mechanism_is_told_apart_from_a_structure(write):
    text = "[model]\nfunction = 'made.py:system'\narguments = { stiffness = 1.0, mu = 0.0 }\n"
    with pytest.raises(
        InputError,
        match=says(
            "system returned a VibrationSystem; expected a System; a function that returns a ForwardModel is named by "
            "forward = in [model], and one that returns a VibrationSystem needs the table [harmonic_balance]"
        ),
    ):
        plan(load(write(text + "[solver]\nstep = 1e-3\n[simulate]\nend = 1.0\n")))
    with pytest.raises(
        InputError,
        match=says(
            "structure returned a Structure; expected a VibrationSystem; the study is of a structure over frequency, "
            "since it has [harmonic_balance] or a task of structures"
        ),
    ):
        plan(load(write(text.replace("system", "structure").replace(", mu = 0.0", "") + CURVE)))


def test_a_law_that_drops_the_imaginary_part_is_refused_in_a_study(write, tmp_path):
    (tmp_path / "law.py").write_text("import numpy as np\ndef drag(u):\n    return 0.1 * np.abs(u) * u\n")
    text = WHOLE.replace(
        "[harmonic_balance]\n",
        '[[model.spring]]\nkind = "UserElement"\nname = "drag"\ndofs = ["m1"]\nfunction = "law.py:drag"\n'
        "[harmonic_balance]\n",
    )
    with pytest.raises(InputError, match=r"element 'drag': the derivative of its force by the displacements is .* abs"):
        run_study(load(write(text)), tmp_path / "run")


def test_a_law_with_its_events_is_named_in_a_study(write, tmp_path):
    (tmp_path / "law.py").write_text(
        "def stop(u, v, z, numbers, force):\n"
        "    over = u[0] - numbers[1]\n"
        "    force[0] = numbers[0] * over if over.real > 0 else 0.0 * over\n"
        "def touch(u, v, z, numbers, values):\n"
        "    values[0] = u[0] - numbers[1]\n"
    )
    own = 'kind = "UserLaw"\nfunction = "law.py:stop"\nvalues = [3.0, 0.05]\nevents = "law.py:touch"\nevent_count = 1\n'
    built_in = 'kind = "Gap"\nstiffness = 3.0\ngap = 0.05\n'

    def amplitudes(name: str, element: str) -> np.ndarray:
        table = f'[[model.spring]]\nname = "stop"\nfirst = "m1"\n{element}[harmonic_balance]\n'
        run_study(load(write(WHOLE.replace("[harmonic_balance]\n", table))), tmp_path / name)
        return FrequencyCurve.load(tmp_path / name / "result.nc").amplitude("m1")

    np.testing.assert_allclose(amplitudes("own", own), amplitudes("gap", built_in), rtol=1e-5)
