"""Changes of studies that findings advise."""

from pathlib import Path

import pytest
import tomlkit

from dalembert.studio.runs import advice
from dalembert.studio.runs.advice import changes, changes_of, start_from_best
from dalembert.studio.runs.differences import differences
from dalembert.study import load
from dalembert.study.template import begin

PENDULUM = """
[parameters]
drag = { lower = 0.0, upper = 1.0, start = 0.1, unit = "N*m*s" } # of the pin
angle = { lower = "-60 deg", upper = "30 deg", start = "-20 deg" }
mass = { lower = 1.0, upper = 4.0, log = true, deviation = 0.5 }
[model]
[[model.body]]
name = "rod"
[[model.joint]]
name = "pin"
slip_rate = 0.01 # rad/s
[solver]
step = "1 ms" # fixed
[data]
file = "a.csv"
[identify]
starts = 4 # spread
"""
BOUNDS = '[propagate]\nmethod = { kind = "optimise", most_runs = 100 }\n'
VERTEX = '[propagate]\nmethod = "vertex"\n'
BEST = {"drag": 0.2, "angle": -0.523598776, "mass": 1.23456789}
CASES = [
    ("integration-bias", {}, PENDULUM, {"Use half the step, 0.5 ms": ['step = "0.5 ms" # fixed']}),
    ("integration-bias-unknown", {}, PENDULUM, {"Use half the step, 0.5 ms": ['step = "0.5 ms" # fixed']}),
    ("rough-misfit", {}, '[solver]\nkind = "RadauIIA"\n', {}),
    (
        "rough-misfit",
        {},
        '[solver]\nkind = "RadauIIA"\ntolerance = 1e-6\n',
        {"Use a tenth of tolerance, 1e-07": ["tolerance = 1e-07"]},
    ),
    (
        "skipped-samples",
        {"apart": 2.5e-4},
        PENDULUM,
        {"Use the distance of the samples as step, 0.25 ms": ['step = "0.25 ms" # fixed']},
    ),
    (
        "slip-rate",
        {"joint": "pin", "slip_rate": 0.01, "proposed": 0.002},
        PENDULUM,
        {"Set slip_rate to 0.002": ["slip_rate = 0.002 # rad/s"]},
    ),
    (
        "slip-rate",
        {"joint": "pin", "slip_rate": 0.01, "proposed": 0.03, "step": 4e-4},
        PENDULUM,
        {
            "Set slip_rate to 0.03": ["slip_rate = 0.03 # rad/s"],
            "Use a smaller step, 0.4 ms": ['step = "0.4 ms" # fixed'],
        },
    ),
    ("correlated-residuals", {}, PENDULUM, {"Use 8 starts": ["starts = 8 # spread"]}),
    ("model-misfit", {}, "[identify]\n", {"Use 16 starts": ["starts = 16"]}),
    ("not-converged", {}, "[identify]\nshooting = true\n", {"Use 6 starts": ["starts = 6"]}),
    ("misfit-above-noise", {}, '[identify.method]\nkind = "pso"\n', {"Use 2 starts": ["[identify]", "starts = 2"]}),
    ("errors-grow", {}, PENDULUM, {"Use multiple shooting": ["shooting = true"]}),
    ("errors-grow", {}, "[identify]\nvalidation = 0.5\n", {}),
    (
        "unidentifiable-parameter",
        {"parameter": "drag"},
        PENDULUM,
        {"Fix drag at 0.2": ['drag = { lower = 0.2, upper = 0.2, unit = "N*m*s" } # of the pin']},
    ),
    (
        "weakly-identifiable-parameter",
        {"parameter": "mass"},
        PENDULUM,
        {"Fix mass at 1.23457": ["mass = { lower = 1.23457, upper = 1.23457 }"]},
    ),
    ("weakly-identifiable-parameter", {"parameter": "warm.mass"}, PENDULUM, {}),
    (
        "unidentifiable-combination",
        {"parameters": "drag, angle", "unseen": True},
        PENDULUM,
        {
            "Fix drag at 0.2": ['drag = { lower = 0.2, upper = 0.2, unit = "N*m*s" } # of the pin'],
            "Fix angle at -30 deg": ['angle = { lower = "-30 deg", upper = "-30 deg" }'],
        },
    ),
    (
        "partly-converged",
        {"parameters": "drag, angle"},
        PENDULUM,
        {
            "Fix drag at 0.2": ['drag = { lower = 0.2, upper = 0.2, unit = "N*m*s" } # of the pin'],
            "Fix angle at -30 deg": ['angle = { lower = "-30 deg", upper = "-30 deg" }'],
        },
    ),
    (
        "indistinguishable-parameters",
        {"parameters": "drag, mass"},
        "[parameters.drag]\nlower = 0 # none\nupper = 1\nstart = 0.5\n[parameters.angle]\nlower = 0\nupper = 1\n",
        {"Fix drag at 0.2": ["lower = 0.2 # none", "upper = 0.2"]},
    ),
    (
        "parameter-at-bound",
        {"parameter": "angle", "side": "upper", "bound": 0.5},
        PENDULUM,
        {
            "Set the upper bound of angle to 120 deg": [
                'angle = { lower = "-60 deg", upper = "120 deg", start = "-20 deg" }'
            ]
        },
    ),
    (
        "interval-at-bound",
        {"parameter": "mass", "side": "lower", "bound": 1.0},
        PENDULUM,
        {"Set the lower bound of mass to 0.1": ["mass = { lower = 0.1, upper = 4.0, log = true, deviation = 0.5 }"]},
    ),
    ("parameter-at-bound", {"parameter": "drag", "side": "lower", "bound": 0.0}, PENDULUM, {}),
    (
        "suspect-delay",
        {"channel": "rod.x", "delay": 0.0123},
        PENDULUM,
        {"Identify the delay of rod.x, up to 0.02 s": ["[sensors]", '"rod.x" = { delay = [0.0, 0.02] }']},
    ),
    ("suspect-delay", {"channel": "", "delay": 0.01}, PENDULUM, {}),
    (
        "search-stopped",
        {"most_runs": 100},
        BOUNDS,
        {"Allow 400 simulations": ['method = { kind = "optimise", most_runs = 400 }']},
    ),
    (
        "search-stopped",
        {"most_runs": 100},
        '[propagate]\nmethod = "optimise" # slow\n',
        {"Allow 400 simulations": ['method = { kind = "optimise", most_runs = 400 } # slow']},
    ),
    ("sampled-bounds", {}, VERTEX, {"Use the method optimise": ['method = "optimise"']}),
    ("linear-bounds", {}, VERTEX, {"Use the method optimise": ['method = "optimise"']}),
    ("unknown-error", {}, VERTEX, {"Compare with the method chebyshev": ['compare = ["chebyshev"]']}),
    ("unknown-error", {}, "[propagate]\n", {}),
    (
        "few-harmonics",
        {"harmonics": 3, "error": 0.02},
        "[frequency_response]\n",
        {
            "Keep 7 harmonics": ["[harmonic_balance]", "harmonics = 7"],
            "Choose the harmonics by the truncation error": ["[harmonic_balance]", 'harmonics = "auto"'],
        },
    ),
    (
        "few-harmonics",
        {"harmonics": 127, "error": 0.02},
        '[harmonic_balance]\nharmonics = "auto"\n',
        {"Allow 255 harmonics": ["most_harmonics = 255"]},
    ),
    (
        "stability-near-fold",
        {"harmonics": 3},
        '[harmonic_balance]\nharmonics = "auto"\n',
        {"Keep at least 7 harmonics": ["least_harmonics = 7"]},
    ),
    (
        "stability-near-fold",
        {"harmonics": 9},
        "[harmonic_balance]\nharmonics = 9 # default\n",
        {"Keep 19 harmonics": ["harmonics = 19 # default"]},
    ),
    ("beam-locking", {"body": "rod"}, PENDULUM, {"Use the structural formulation": ['formulation = "structural"']}),
    ("late-samples", {"first": 1.0}, PENDULUM, {"Start the motion with the record": ['start = "first"']}),
    ("paving-unfinished", {}, "[identify_set]\nmost_boxes = 50\n", {"Allow 200 boxes": ["most_boxes = 200"]}),
    ("systematic-residuals", {"channel": "rod.x"}, PENDULUM, {}),
]


@pytest.mark.parametrize(
    ("code", "values", "text", "wanted"),
    CASES,
    ids=lambda given: given if isinstance(given, str) and "\n" not in given else "",
)
def test_a_finding_changes_what_it_advises(code, values, text, wanted):
    found = {}
    for change in changes(code, values, tomlkit.parse(text), BEST):
        document = tomlkit.parse(text)
        change.apply(document)
        lines = differences(text, tomlkit.dumps(document))
        found[change.label] = [line for kind, line in lines if kind == "added" and line]
    assert found == wanted


def test_each_code_is_tested_and_documented():
    assert {code for code, _, _, wanted in CASES if wanted} == set(advice._ADVICE)
    page = Path(__file__).parents[4] / "docs" / "how-to" / "findings.md"
    documented = page.read_text(encoding="utf-8")
    assert [code for code in advice._ADVICE if f"`{code}`" not in documented] == []


def test_changed_studies_are_in_order(tmp_path):
    path = begin("identify", tmp_path / "pendulum")
    text, best = path.read_text(), {"drag": 0.2, "angle": -0.5235}
    given = [
        ("integration-bias", {}),
        ("model-misfit", {}),
        ("errors-grow", {}),
        ("unidentifiable-combination", {"parameters": "drag, angle"}),
        ("parameter-at-bound", {"parameter": "angle", "side": "upper", "bound": 0.0}),
        ("suspect-delay", {"channel": "rod.end.x", "delay": 0.01}),
    ]
    for code, values in given:
        for change in changes(code, values, tomlkit.parse(text), best):
            document = tomlkit.parse(text)
            assert start_from_best(document, best)
            change.apply(document)
            path.write_text(tomlkit.dumps(document))
            assert load(path).task == "identify", change.label


def test_the_identified_values_become_the_start():
    document = tomlkit.parse(PENDULUM)
    assert start_from_best(document, {**BEST, "warm.mass": 2.0, "mass": 9.0})
    lines = [line for kind, line in differences(PENDULUM, tomlkit.dumps(document)) if kind == "added"]
    assert lines == [
        'drag = { lower = 0.0, upper = 1.0, start = 0.2, unit = "N*m*s" } # of the pin',
        'angle = { lower = "-60 deg", upper = "30 deg", start = "-30 deg" }',
        "mass = { lower = 1.0, upper = 4.0, log = true, deviation = 0.5, start = 4.0 }",
    ]
    assert not start_from_best(document, {})


def test_the_changes_of_a_run():
    finding = {"code": "model-misfit", "severity": "warning", "message": "x", "advice": "y"}
    state = {"findings": [{**finding, "values": {}}, {**finding, "code": "other", "values": {}}]}
    assert [change.label for change in changes_of(state, tomlkit.parse(PENDULUM))] == ["Use 8 starts"]
    twice = {"findings": [{**finding, "values": {}}, {**finding, "values": {}}]}
    assert [change.label for change in changes_of(twice, tomlkit.parse(PENDULUM))] == ["Use 8 starts"]
    assert changes_of({}, tomlkit.parse(PENDULUM)) == []
