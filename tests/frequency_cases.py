"""Small studies of vibrations that provoke every figure and every sentence of their reports."""

from dataclasses import replace
from typing import Any

import numpy as np

from dalembert.structure import (
    Campbell,
    Dofs,
    Material,
    Modal,
    ReducedStructure,
    Structure,
    box,
    craig_bampton,
    eigenmodes,
    lumped,
    mode_shapes,
    solid,
)
from dalembert.vibration import (
    CubicSpring,
    ElasticSlider,
    FrequencyCurve,
    FrictionContact,
    HarmonicBalance,
    HarmonicForce,
    HeldAmplitude,
    Newmark,
    StaticContact,
    UserLaw,
    VibrationSystem,
    backbone,
    compare_in_time,
    deformation,
    follow_branch,
    frequency_response,
    frequency_responses,
    isolated_branches,
    static_contact,
    steady_state,
    track_resonance,
)
from dalembert.vibration.stability.bifurcations import rows_findings
from lap_joint import bars, lap_joint
from report_case import Case
from vibrating_systems import chain, duffing, one_mass, two_masses

HZ = 1 / (2 * np.pi)
AROUND = HZ * np.linspace(0.9, 1.3, 9)
FEW = HarmonicBalance(harmonics=3, samples=256)


def _stuck() -> VibrationSystem:
    system = one_mass()
    system.forces[0] = replace(system.forces[0], amplitude=1e-3)
    return system


def _branched() -> tuple[FrequencyCurve, dict[str, Any]]:
    """A mass with a hardening spring that prefers no side, and the motions that do; an isolated branch of another."""
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.1)]))
    system.add(HarmonicForce("m", 4.0))
    system.add(CubicSpring("hardening", "m", stiffness=1.0))
    ends = 0.12, 0.2
    curve = frequency_response(system, ends, HarmonicBalance(9), continuation="arc-length", stability=True)
    damped = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.1)]))
    damped.add(HarmonicForce("m", 0.0375))
    damped.add(UserLaw("damper", "m", function=_damper))
    outside = frequency_response(damped, ends, HarmonicBalance(1))
    (isolated,) = isolated_branches(damped, outside, [HZ])
    return curve, {"branches": {"branch 1": follow_branch(system, curve), "isolated 1": isolated}}


def _damper(u, v, z, numbers, force):
    """A damper that takes less at medium speeds."""
    force[0] = -0.1 * v[0] ** 3 + 0.03 * v[0] ** 5


def _bolted() -> StaticContact:
    mesh, between = bars(4, 2)
    return static_contact(lap_joint(mesh, mesh, between, 0.0, 1e4))


def _row(masses: int) -> VibrationSystem:
    """A chain of masses between walls, with a slider on every second one."""
    names = [f"m{number}" for number in range(1, masses + 1)]
    springs = [(a, b, 1.0, 0.03) for a, b in zip([None, *names], [*names, None], strict=True)]
    system = VibrationSystem(
        lumped(dict.fromkeys(names, 1.0), [(b or a, a if b else None, k, c) for a, b, k, c in springs])
    )
    system.add(HarmonicForce("m1", 1.0))
    for name in names[::2]:
        system.add(FrictionContact(f"slider {name}", name, friction=0.3, preload=1.0, law=ElasticSlider(1.0)))
    return system


def _turning() -> VibrationSystem:
    """A mass that moves along x and a disc that turns about z, on one shaft."""
    stiffness = np.array([[2.0, -1.0], [-1.0, 2.0]])
    system = VibrationSystem(Structure(np.eye(2), stiffness, Dofs(("a.x", "a.rz")), 0.02 * stiffness))
    system.add(HarmonicForce("a.rz", 1.0))
    return system


def damped(preload: float) -> VibrationSystem:
    system = two_masses()
    system.elements[0] = replace(system.elements[0], preload=preload)  # type: ignore[type-var]
    return system


def _family(preloads: list[float], method: HarmonicBalance = FEW) -> Any:
    return frequency_responses(damped, "preload", preloads, (0.7 * HZ, 1.3 * HZ), method, unit="N")


def _folded(**options: Any) -> FrequencyCurve:
    ends, method = (0.8 * HZ, 1.6 * HZ), HarmonicBalance(harmonics=5)
    return frequency_response(duffing(), ends, method, continuation="arc-length", **options)


def _timed(**settings: Any) -> tuple[VibrationSystem, FrequencyCurve, Any]:
    system = two_masses()
    curve = frequency_response(system, HZ * np.linspace(0.8, 1.0, 5), HarmonicBalance(harmonics=5))
    return system, curve, compare_in_time(system, curve, points=[0, 2, 4], method=Newmark(**settings))


def _backbone(system: VibrationSystem, amplitudes: list[float], **settings: Any) -> Any:
    return backbone(system, np.array(amplitudes), method=HarmonicBalance(harmonics=3, **settings))


def _track(values: list[float], start: tuple[float, float], **settings: Any) -> Any:
    return track_resonance(
        damped, "preload", values, start, HarmonicBalance(harmonics=3, samples=256, **settings), dof="m2.x", unit="N"
    )


def _full() -> Structure:
    return solid(box((0.4, 0.1, 0.004), (6, 2, 1)), Material(210e9, 0.3, 7800.0)).fixed("left")


def _reduced() -> ReducedStructure:
    return craig_bampton(_full(), "right", modes=6)


def strip() -> VibrationSystem:
    """A clamped strip with three feet that rub on the ground, reduced."""
    full = _full()
    assert full.nodes is not None
    feet = [full.nodes.nearest(place) for place in ((0.4, 0.0, 0.0), (0.4, 0.1, 0.0), (0.2, 0.05, 0.0))]
    system = VibrationSystem(craig_bampton(full, feet, modes=6).with_damping(Modal(0.01)))
    system.add(HarmonicForce(f"{feet[0]}.z", 2.0))
    system.add(HarmonicForce(f"{feet[0]}.x", 200.0))
    for number, foot in enumerate(feet, 1):
        law = ElasticSlider(1e4, 1e4)
        contact = FrictionContact(f"foot {number}", foot, normal="z", friction=1e-3, preload=2.0, law=law)
        system.add(contact)
    return system


def _shaken() -> tuple[FrequencyCurve, Any]:
    system = strip()
    curve = frequency_response(system, np.linspace(60.0, 90.0, 7), FEW)
    return curve, {"deformation": deformation(system, curve)}


def _rotating() -> Campbell:
    """A backward and a forward mode over the speed, with a motion that grows at the last one."""
    speeds = np.arange(5.0)
    roots = 1j * (2.0 + np.outer(speeds, [-0.3, 0.4]))
    whirl = np.tile([-1.0, 1.0], (5, 1))
    growth = np.array([0.0, 0.0, 0.0, 0.0, 0.1])
    return Campbell("speed", "rad/s", speeds, speeds, roots, whirl, growth, "fixed")


FREQUENCY_CASES: dict[str, Case] = {
    # ── forced response ─────────────────────────────────────────────────────────────────────────────────────────────
    "a response with friction": Case(
        lambda: frequency_response(two_masses(), HZ * np.linspace(0.7, 1.1, 9), HarmonicBalance(harmonics=7)),
        (
            "All 9 points between",
            "the contacts are stuck for",
            "% of the period, slip for",
            "J from the motion in each period.",
            "At the peak the last two harmonics kept are at most",
            "Twice as many samples of a period would change the forces by at most",
        ),
        ("frequency-curve", "contact-states", "hysteresis", "dissipation", "harmonic-content", "points-found"),
    ),
    "a response with few harmonics and samples": Case(
        lambda: frequency_response(chain(), HZ * np.linspace(1.0, 2.2, 9), HarmonicBalance(harmonics=2, samples=8)),
        ("harmonics kept still reach", "keep more harmonics.", "allowed: give more samples."),
    ),
    "a response with chosen harmonics": Case(
        lambda: frequency_response(two_masses(), AROUND, HarmonicBalance("auto")),
        ("harmonics were chosen: the largest of the estimated truncation errors is",),
    ),
    "a response whose contacts stick": Case(
        lambda: frequency_response(_stuck(), AROUND, HarmonicBalance(harmonics=9, odd_only=True, samples=256)),
        ("They stick all the time there: what damps is the", "1, 3 … 9"),
    ),
    "a response of many masses": Case(
        lambda: frequency_response(_row(8), AROUND, FEW),
        (
            "Drawn are 6 degrees of freedom of the 8 observed, in the table those that move most.",
            "Mean of all contacts.",
        ),
        ("contact-shares",),
        {"amplitude": "rms"},
    ),
    "a response without contacts": Case(lambda: frequency_response(_turning(), AROUND, FEW), ("computed",)),
    "a response with folds": Case(
        _folded,
        ("The path has folds at", "Drawn for the point of the curve where m.x is largest, "),
        ("spring-forces",),
    ),
    "a response that is unstable": Case(
        lambda: _folded(stability=True),
        ("are unstable: the structure does not stay in these motions.", "Dashed: unstable motions."),
    ),
    "a response of which points are not found": Case(
        lambda: frequency_response(
            chain(), HZ * np.linspace(1.0, 2.2, 25), HarmonicBalance(harmonics=5, samples=256, iterations=7, halvings=0)
        ),
        ("points between", "were not found; they are marked", "Crosses: not found.", "Points that were not found"),
    ),
    "a response with other branches": Case(
        _branched,
        ("Branch 1 lies between", "Isolated 1 lies between", "and is closed: no sweep of the frequency comes to it"),
    ),
    "a response of which contacts are too many to judge": Case(
        lambda: replace(one := _folded(stability=True), findings=(*one.findings, *rows_findings([0.2]))),
        ("The stability of 1 point between 0.2 and 0.2 Hz is not known: more than",),
    ),
    "a response whose amplitude is held": Case(
        lambda: frequency_response(two_masses(), AROUND, FEW, control=HeldAmplitude("m2", 0.5)),
        ("Held amplitude", "All forces but static ones have this factor, so that the amplitude is held."),
        ("load-factors",),
    ),
    "a joint at rest": Case(
        _bolted,
        ("Contacts at rest", "Coloured by the normal force; a thick ring: the contact slips; hollow: it is open."),
        ("normal-forces",),
    ),
    "a response that is not found": Case(
        lambda: frequency_response(two_masses(), AROUND, HarmonicBalance(harmonics=7, iterations=1, halvings=0)),
        ("! not found",),
    ),
    # ── over a parameter ────────────────────────────────────────────────────────────────────────────────────────────
    "responses over a preload": Case(
        lambda: _family([0.0, 2.0, 4.0, 12.0]),
        (
            "Forced response over preload",
            "The smallest peak of m2.x is at preload = 4 N:",
            "% below that at 0 N.",
            "From 0 N to 12 N the frequency of the peak goes from",
            "With preload = 4 N, at the point of the curve where m2.x is largest, ",
        ),
        ("curve-family-1", "family-peaks-1", "contact-states"),
    ),
    "responses over a preload that should be larger, and one that fails": Case(
        lambda: _family([-1.0, 0.0, 1.0, 2.0]),
        (
            "! incomplete",
            "It lies at the end of the values: beyond them the peak may be smaller still.",
            "preload is -1 N; expected zero or a positive number",
        ),
    ),
    "responses over a preload that are not found": Case(
        lambda: _family([1.0, 2.0], HarmonicBalance(harmonics=7, iterations=1, halvings=0)), ("! incomplete",)
    ),
    # ── time, nonlinear modes, resonances ───────────────────────────────────────────────────────────────────────────
    "a response beside time integration": Case(
        lambda: (lambda system, curve, compared: (curve, {"time_comparison": compared}))(*_timed(steps_per_period=256)),
        (
            "3 points were integrated in time with 256 steps a period",
            "Harmonic balance differs by at most",
            "% of the largest motion, for m",
            "Crosses: in time; circles: harmonic balance",
        ),
        ("frequency-curve", "time-comparison"),
    ),
    "time integration alone": Case(
        lambda: _timed(steps_per_period=256)[2], ("All points are periodic in time.",), ("time-comparison",)
    ),
    "time integration that is not periodic yet": Case(
        lambda: _timed(steps_per_period=64, periods=2)[2],
        ("Some points are not periodic in time yet.", "Not periodic yet in time, so not to be compared:"),
    ),
    "a nonlinear mode that stiffens": Case(
        lambda: (_folded(), {"backbone": _backbone(duffing(), [0.1, 0.5, 1.0, 2.0, 3.0])}),
        ("of m.x the mode stiffens: its frequency goes from", "Dotted: the nonlinear mode without force."),
        ("frequency-curve", "backbone"),
    ),
    "a nonlinear mode with friction": Case(
        lambda: _backbone(two_masses(), [0.1, 0.5, 1.0, 2.0, 10.0]),
        ("Mode 1 was found at 5 of 5 amplitudes of", "the mode softens", "It is damped most, by a ratio of"),
    ),
    "a nonlinear mode that is linear": Case(
        lambda: _backbone(_turning(), [0.1, 0.2]), ("the frequency of the mode stays at",)
    ),
    "a nonlinear mode that turns back": Case(
        lambda: backbone(chain(), (0.6, 1.1), method=FEW),
        ("! incomplete", "The path passes a fold and leaves the range at 0.6 m", "It does not reach 1.1 m."),
    ),
    "a nonlinear mode that is not found": Case(
        lambda: _backbone(duffing(), [1.0, 3.0], iterations=1, halvings=0), ("! incomplete", "0 of 2 amplitudes")
    ),
    "a resonance over a preload": Case(
        lambda: _track([12.0, 10.0, 8.0, 6.0, 4.0, 3.0], (0.7 * HZ, 1.4 * HZ)),
        (
            "Resonance over preload",
            "The peak was found at 6 of 6 values of preload.",
            "smallest peak of m2.x",
            "Followed by ",
            " balanced points, without whole curves; this peak",
        ),
        ("resonance-track",),
    ),
    "a resonance that is not found": Case(
        lambda: _track([12.0, 0.0], (0.7 * HZ, 1.4 * HZ), iterations=2, halvings=0), ("! incomplete",)
    ),
    # ── shapes ──────────────────────────────────────────────────────────────────────────────────────────────────────
    "a response with its deformed shape": Case(
        _shaken,
        (
            "Displacements drawn",
            "times as large as they are; thin lines: at rest.",
            "Filled: the state at the phase shown; ring: the state held for longest;",
            "Of all the energy that friction takes, foot",
        ),
        ("frequency-curve", "deformation", "interface-map"),
    ),
    "a deformed shape alone": Case(
        lambda: _shaken()[1]["deformation"],
        ("The motion of the whole structure at one point of a response over frequency.", "slower than real"),
        ("deformation", "interface-map"),
    ),
    "mode shapes": Case(
        lambda: mode_shapes(strip().structure, eigenmodes(strip().structure, 13)),
        (
            "13 natural frequencies and shapes of the undamped structure.",
            "The slider goes through the modes; thin lines: at rest; dark: nodal lines.",
            "Drawn are the first 12.",
        ),
        ("mode-shapes",),
    ),
    "a Campbell diagram": Case(
        _rotating,
        (
            "2 modes at 5 speeds, seen in the fixed frame.",
            "Solid lines: modes that whirl forward; dashed: backward; dotted: along a line.",
            "The steady rotation is unstable at 1 of 5 speeds, the lowest of them 4 rad/s: a motion grows by up to",
        ),
        ("campbell",),
    ),
    "a reduced structure": Case(
        lambda: _reduced().errors(_full(), 5),
        ("The lowest modes of the reduced structure beside", "% too high, and their shapes are similar by"),
        ("reduction-errors",),
    ),
    "a response of a reduced structure": Case(
        lambda: (frequency_response(_turning(), AROUND, FEW), {"reduction": _reduced().errors(_full(), 5)}),
        ("What is zero to rounding is not drawn.",),
        ("frequency-curve", "reduction-errors"),
    ),
    "a periodic motion in time": Case(
        lambda: steady_state(two_masses(), 0.9 * HZ, Newmark(steps_per_period=128)),
        ("The motion repeats itself.", "The last period of the integration."),
        ("periodic-motion", "loops-in-time"),
    ),
    "a motion in time that is not periodic": Case(
        lambda: steady_state(two_masses(), 0.9 * HZ, Newmark(steps_per_period=64, periods=2)),
        ("The motion does not repeat itself yet.",),
    ),
}
