"""Structures and vibrating systems with invalid input of all kinds: a sentence each, no traceback."""

import math
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from dalembert.errors import DalembertError
from dalembert.structure import (
    Dofs,
    Material,
    Modal,
    Rayleigh,
    Structure,
    box,
    combine,
    craig_bampton,
    eigenmodes,
    lumped,
    plate,
    read_structure,
    solid,
    tie,
)
from dalembert.vibration import (
    BilinearStop,
    CubicSpring,
    ElasticSlider,
    FrequencyCurve,
    FrequencyResponse,
    FrictionContact,
    Gap,
    HarmonicBalance,
    HarmonicForce,
    Iwan,
    Newmark,
    Rigid,
    StaticForce,
    UserElement,
    VibrationSystem,
    backbone,
    compare_in_time,
    floquet_multipliers,
    frequency_response,
    frequency_responses,
    steady_state,
    track_resonance,
)

FORCE = HarmonicForce("m", 1.0)
METHOD = HarmonicBalance(3)
STEEL = Material(210e9, 0.3, 7800.0)
M = Dofs(("m.x",))


def bob() -> Structure:
    return lumped({"m": 1.0}, [("m", None, 1.0, 0.1)])


def plane() -> Structure:
    """A node that moves along x and y."""
    return lumped({"a.x": 1.0, "a.y": 1.0}, [("a.x", None, 1.0, 0.1), ("a.y", None, 1.0, 0.1)])


def system(*parts, structure: Structure | None = None) -> VibrationSystem:
    made = VibrationSystem(structure or bob())
    for part in parts:
        made.add(part)
    return made


def run(*parts, frequencies=(0.1, 0.2), method=METHOD, structure: Structure | None = None, **options) -> FrequencyCurve:
    if isinstance(frequencies, list):
        frequencies = np.array(frequencies)
    return frequency_response(system(*parts, structure=structure), frequencies, method, **options)


def contact(**given) -> FrictionContact:
    return FrictionContact(**{"name": "c", "first": "m", "friction": 0.5, "preload": 1.0, **given})


def user(function, dofs=("m",)) -> FrequencyCurve:
    return run(FORCE, UserElement("law", dofs, function))


def damped(preload) -> VibrationSystem:
    return system(FORCE, contact(preload=preload, law=ElasticSlider(1.0)))


NAN, INF = math.nan, math.inf
CASES: dict[str, tuple[Callable[[], object], str]] = {
    # masses, springs and matrices
    "a negative mass": (
        lambda: lumped({"m": -1.0}, []),
        "Structure: the mass of 'm.x' is -1 kg; expected a number that",
    ),
    "a mass as text": (lambda: lumped({"m": "1 kg"}, []), "lumped: masses is {'m': '1 kg'}; expected a mapping"),
    "masses as a list": (lambda: lumped(["m"], []), "lumped: masses is ['m']; expected a mapping"),
    "no masses": (lambda: lumped({}, []), "Structure: there are no degrees of freedom"),
    "no springs": (lambda: lumped({"m": 1.0}, None), "lumped: springs is None; expected a list"),
    "a spring without damping": (
        lambda: lumped({"m": 1.0}, [("m", None, 1.0)]),
        "spring 1 is ('m', None, 1.0); expected",
    ),
    "a stiffness as text": (
        lambda: lumped({"m": 1.0}, [("m", None, "1", 0.0)]),
        "spring 1: the stiffness is '1'; expected a finite number",
    ),
    "an infinite stiffness": (lambda: lumped({"m": 1.0}, [("m", None, INF, 0.0)]), "spring 1: the stiffness is inf"),
    "a spring on a number": (lambda: lumped({"m": 1.0}, [(1, None, 1.0, 0.0)]), "unknown mass 1; known: m"),
    "a spring to itself": (lambda: lumped({"m": 1.0}, [("m", "m", 1.0, 0.0)]), "spring 1 connects 'm' with itself"),
    "a matrix as text": (lambda: Structure("a", np.eye(1), M), "Structure: the mass is array('a'"),
    "no stiffness": (lambda: Structure(np.eye(1), None, M), "expected a matrix of numbers"),
    "names as a tuple": (
        lambda: Structure(np.eye(1), np.eye(1), ("m.x",)),
        "Structure: dofs is ('m.x',); expected Dofs",
    ),
    "nodes as text": (lambda: Structure(np.eye(1), np.eye(1), M, nodes="m"), "Structure: nodes is 'm'; expected Nodes"),
    "negative masses": (lambda: Structure(-np.eye(1), np.eye(1), M), "Structure: the mass of 'm.x' is -1 kg"),
    "names as numbers": (lambda: Dofs((1, 2)), "Dofs: names is 1; expected names"),
    "damping as a number": (lambda: bob().with_damping(0.01), "with_damping: damping is 0.01; expected Modal(ratio)"),
    "a ratio as text": (lambda: Modal("1 %"), "Modal: ratio is '1 %'; expected a number"),
    "a factor as text": (lambda: Rayleigh("1", 0.0), "Rayleigh: mass is '1'; expected a number in 1/s"),
    "clamped by number": (lambda: bob().fixed([0]), "is 0; expected names"),
    "all clamped": (lambda: bob().fixed("m"), "there are no degrees of freedom, perhaps all are clamped"),
    "two and a half modes": (lambda: craig_bampton(bob(), "m", 2.5), "craig_bampton: modes is 2.5; expected a whole"),
    "masters of nothing": (lambda: craig_bampton(bob(), None), "is None; expected names"),
    "a matrix to reduce": (lambda: craig_bampton(np.eye(2), ["m"]), "craig_bampton: structure is array("),
    "half a mode": (lambda: eigenmodes(bob(), 0.5), "eigenmodes: count is 0.5; expected a whole number"),
    "parts as a list": (lambda: combine([bob()]), "combine: parts is"),
    "no parts": (lambda: combine({}), "combine: there are no parts"),
    "a pair of three": (lambda: tie(bob(), [("m", "m", "m")]), "tie: joined is [('m', 'm', 'm')]"),
    "a number as a path": (lambda: read_structure(3), "read_structure: path is 3; expected a path"),
    "a modulus as text": (
        lambda: Material("210e9", 0.3, 1.0),
        "Material: youngs_modulus is '210e9'; expected a number",
    ),
    "a box in the plane": (lambda: box((1.0, 1.0), (1, 1, 1)), "box: size is (1.0, 1.0); expected three positive"),
    "a flat box": (lambda: box((1.0, 1.0, 0.0), (1, 1, 1)), "box: size is (1.0, 1.0, 0.0); expected three positive"),
    "a box of half elements": (lambda: box((1.0, 1.0, 1.0), (1.5, 1, 1)), "elements is (1.5, 1, 1); expected"),
    "a box of no elements": (lambda: box((1.0, 1.0, 1.0), (0, 1, 1)), "elements is (0, 1, 1); expected three positive"),
    "a line as a plate": (lambda: plate((1.0,), 1e-3, STEEL, (2, 2)), "plate: size is (1.0,); expected two positive"),
    "half an element": (lambda: plate((1.0, 1.0), 1e-3, STEEL, (2.5, 2)), "plate: elements is (2.5, 2); expected"),
    "no mesh": (lambda: solid(3, STEEL), "solid: mesh is 3; expected a mesh of scikit-fem"),
    "a missing mesh": (lambda: solid("none.inp", STEEL), "none.inp: there is no such file"),
    "no material": (lambda: solid(box((1.0, 1.0, 1.0), (1, 1, 1)), None), "solid: material is None; expected"),
    # systems and forces
    "a matrix as a system": (lambda: VibrationSystem(np.eye(2)), "VibrationSystem: structure is array("),
    "nothing added": (lambda: system(None), "None was added to a vibrating system"),
    "a force of NaN": (
        lambda: HarmonicForce("m", NAN),
        "HarmonicForce: amplitude is nan; expected a finite number in N",
    ),
    "an infinite force": (lambda: HarmonicForce("m", INF), "HarmonicForce: amplitude is inf; expected a finite number"),
    "a phase of NaN": (
        lambda: HarmonicForce("m", 1.0, NAN),
        "HarmonicForce: phase is nan; expected a finite number in",
    ),
    "a force as text": (lambda: HarmonicForce("m", "1 N"), "HarmonicForce: amplitude is '1 N'; expected a number in N"),
    "forces in a list": (lambda: HarmonicForce("m", [1.0, 2.0]), "HarmonicForce: amplitude is [1.0, 2.0]; expected"),
    "one and a half harmonics": (
        lambda: HarmonicForce("m", 1.0, harmonic=1.5),
        "HarmonicForce: harmonic is 1.5; expected",
    ),
    "a force on a number": (lambda: HarmonicForce(0, 1.0), "HarmonicForce: dof is 0; expected a text"),
    "a weight of NaN": (lambda: StaticForce("m", NAN), "StaticForce: value is nan; expected a finite number in N"),
    "no force": (lambda: run(contact()), "frequency_response: no force acts on the system"),
    # contacts
    "a contact with itself": (lambda: contact(second="m"), "contact 'c' is between the node 'm' and itself"),
    "a function as a law": (
        lambda: contact(law=lambda u: u),
        "law is a function; expected ElasticSlider, Iwan or Rigid",
    ),
    "a law by name": (
        lambda: contact(law="elastic"),
        "contact 'c': law is 'elastic'; expected ElasticSlider(...), Iwan(...)",
    ),
    "a law's class": (lambda: contact(law=Rigid), "contact 'c': law is the class Rigid; expected"),
    "friction as text": (lambda: contact(friction="0.5"), "FrictionContact 'c': friction is '0.5'; expected a number"),
    "a tangential vector": (lambda: contact(tangential=(1.0, 0.5)), "tangential is (1.0, 0.5); expected names of"),
    "an array as tangential": (lambda: contact(tangential=np.ones(2)), "tangential is array([1., 1.]); expected names"),
    "three tangentials": (
        lambda: contact(tangential=("x", "y", "z")),
        "the directions are x, y, z, normal None; expected",
    ),
    "z at a node in the plane": (
        lambda: run(HarmonicForce("a.x", 1.0), contact(first="a", tangential=("x", "z")), structure=plane()),
        "contact 'c': unknown degree of freedom 'a.z'",
    ),
    "a normal vector": (lambda: contact(normal=(0, 0, 1)), "FrictionContact 'c': normal is (0, 0, 1); expected a text"),
    "a node by number": (lambda: contact(first=0), "FrictionContact 'c': first is 0; expected a text"),
    "a law's stiffness as text": (
        lambda: ElasticSlider("1"),
        "ElasticSlider: tangential_stiffness is '1'; expected a number in N/m",
    ),
    "a gap of NaN": (lambda: ElasticSlider(1.0, gap=NAN), "ElasticSlider: gap is nan; expected a finite number in m"),
    "a cell alone": (lambda: Iwan(1.0, 1.0), "Iwan: stiffnesses is 1.0; expected a list"),
    "a negative share": (lambda: Iwan((1.0, 1.0), (2.0, -1.0)), "Iwan: shares is -1; expected zero or a positive"),
    "a penalty as text": (lambda: Rigid("1"), "Rigid: penalty is '1'; expected a number in N/m"),
    # springs and laws of the user's
    "a cubic spring of NaN": (
        lambda: CubicSpring("k", "m", stiffness=NAN),
        "CubicSpring 'k': stiffness is nan; expected",
    ),
    "a gap as text": (lambda: Gap("k", "m", stiffness=1.0, gap="1"), "Gap 'k': gap is '1'; expected a number in m"),
    "a negative gap": (
        lambda: BilinearStop("k", "m", stiffness=1.0, gap=-1.0),
        "BilinearStop 'k': gap is -1 m; expected",
    ),
    "a stop with itself": (
        lambda: run(FORCE, Gap("k", "m.x", "m", stiffness=1.0)),
        "element 'k' is between 'm.x' and itself",
    ),
    "no degrees of freedom": (lambda: user(lambda u: u, ()), "element 'law': dofs is []; expected one or more"),
    "a number as a law": (lambda: user(3.0), "UserElement 'law': function is 3.0; expected a function"),
    "a law with a state": (lambda: user(lambda u: (u, u)), "A law with internal state cannot be a function"),
    "a law of a state": (
        lambda: user(lambda u, z: u),
        "cannot be called with displacements alone: missing a required argument: 'z'. A law with internal state cannot",
    ),
    "a law without answer": (
        lambda: user(lambda u: None),
        "element 'law': its function returned None for displacements",
    ),
    "a law of one number": (
        lambda: user(lambda u: u[0, 0]),
        "its function returned np.float64(0.0) for displacements of",
    ),
    "a law of another shape": (lambda: user(lambda u: np.zeros((3, 4))), "returned an array of shape (3, 4) for"),
    "a law by abs": (lambda: user(lambda u: np.abs(u) * u), "Its function drops the imaginary part, as abs"),
    # methods and calls
    "two and a half harmonics": (lambda: HarmonicBalance(2.5), "HarmonicBalance: harmonics is 2.5; expected a whole"),
    "no iterations": (
        lambda: HarmonicBalance(3, iterations=0),
        "HarmonicBalance: iterations is 0; expected a whole number of at least 1",
    ),
    "negative halvings": (
        lambda: HarmonicBalance(3, halvings=-1),
        "HarmonicBalance: halvings is -1; expected zero or a positive whole number",
    ),
    "steps of NaN": (lambda: Newmark(NAN), "Newmark: steps_per_period is nan; expected a whole number"),
    "a number as a method": (
        lambda: run(FORCE, method=7),
        "frequency_response: method is 7; expected a HarmonicBalance",
    ),
    "a structure as a system": (
        lambda: frequency_response(bob(), [0.1]),
        "frequency_response: system is a Structure; expected",
    ),
    "frequencies as text": (
        lambda: run(FORCE, frequencies="1 Hz"),
        "frequency_response: frequencies is '1 Hz'; expected",
    ),
    "complex frequencies": (lambda: run(FORCE, frequencies=[1j]), "frequency_response: frequencies is array([0.+1.j])"),
    "observed by number": (lambda: run(FORCE, observe=0), "is 0; expected names"),
    "a curve as a start": (lambda: run(FORCE, start=run(FORCE)), "frequency_response: start is"),
    "a start behind the end": (
        lambda: run(FORCE, start=(run(FORCE), 999)),
        "the point is 999; expected a number below",
    ),
    "a number as a callback": (
        lambda: run(FORCE, on_point=3),
        "frequency_response: on_point is 3; expected a function",
    ),
    "a number as a checkpoint": (lambda: run(FORCE, checkpoint=3), "frequency_response: checkpoint is 3; expected a"),
    "amplitudes as text": (lambda: backbone(system(), "1 mm"), "backbone: amplitudes is '1 mm'; expected real numbers"),
    "a mode and a half": (lambda: backbone(system(), [1.0], 1.5), "backbone: mode is 1.5; expected a whole number"),
    "a frequency as text": (lambda: steady_state(system(FORCE), "1 Hz"), "steady_state: frequency is '1 Hz'; expected"),
    "harmonic balance in time": (lambda: steady_state(system(FORCE), 0.1, METHOD), "steady_state: method is"),
    "no curve to compare": (lambda: compare_in_time(system(FORCE), None), "compare_in_time: curve is None; expected a"),
    "no curve to judge": (lambda: floquet_multipliers(system(FORCE), None, 0), "floquet_multipliers: curve is None"),
    "a family over a parameter that is not there": (
        lambda: frequency_responses(damped, "load", [1.0, 2.0], np.array([0.1])),
        "cannot be called with load: missing a required argument: 'preload'",
    ),
    "a peak over a parameter that is not there": (
        lambda: track_resonance(damped, "load", [1.0, 2.0], (0.1, 0.2), dof="m"),
        "cannot be called with load: missing a required argument: 'preload'",
    ),
    "a model of frequencies as text": (
        lambda: FrequencyResponse(damped, {"preload": (1.0, 2.0)}, ["m peak"], "a"),
        "FrequencyResponse: frequencies is 'a'; expected a list of real numbers",
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_a_sentence_says_what_is_wrong(case: str) -> None:
    call, sentence = CASES[case]
    with pytest.raises(DalembertError, match=re.escape(sentence)):
        call()


def test_a_file_that_is_no_mesh_is_a_sentence(tmp_path: Path) -> None:
    for name in ("mesh.inp", "mesh.unknown"):
        (tmp_path / name).write_text("nothing\n")
        with pytest.raises(DalembertError, match=f"{name}: no mesh can be read from it"):
            solid(tmp_path / name, STEEL)
