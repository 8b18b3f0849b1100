"""The real command, as a user starts it: what it prints, and its exit codes."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from dalembert import __version__

COMMAND = Path(sys.executable).with_name("dalembert")
DECAY = """
import numpy as np
from dalembert.forward import PythonModel

times = np.linspace(0, 1, 11)

def decay(parameters):
    return PythonModel(response, parameters, ["x"], times)

def response(rate):
    if np.real(rate) > 2.5:
        raise ValueError("too fast")
    return np.exp(-rate * times)
"""
SWEEP = """
[parameters]
rate = { lower = 0.5, upper = "2 1/s" }
[model]
forward = "decay.py:decay"
[sweep]
at = 0.5
channels = ["x"]
over = { rate = { count = 4 } }
"""


@pytest.fixture
def dalembert(tmp_path):
    (tmp_path / "decay.py").write_text(DECAY)
    (tmp_path / "decay.toml").write_text(SWEEP)

    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [COMMAND, *arguments]
        return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False)

    return run


def test_run_list_report(dalembert, tmp_path):
    ran = dalembert("run", "decay.toml")
    assert ran.returncode == 0
    status = "Responses at time 0.5 s, one parameter varied at a time: rate. 4 points."
    assert ran.stdout == f"values of rate  4\n\n{status}\nreport: runs/decay/report.html\n"
    assert (tmp_path / "runs/decay/report.html").stat().st_size > 100_000
    again = dalembert("run", "decay.toml", "--force")
    assert (again.returncode, again.stdout) == (0, ran.stdout)
    listed = dalembert("list")
    assert listed.returncode == 0
    assert listed.stdout.split()[:6] == ["run", "task", "state", "since", "best", "findings"]
    assert listed.stdout.split()[6:9] == ["decay", "sweep", "finished"]
    made = dalembert("report", "decay")
    assert (made.returncode, made.stdout) == (0, "report: runs/decay/report.html\n")
    assert dalembert("report", "runs/decay").stdout == made.stdout


@pytest.mark.slow
def test_a_fit_with_a_fixed_parameter(dalembert, tmp_path):
    rows = "".join(f"{k / 10},{2.71828 ** (-0.12 * k) + 1e-3 * (-1) ** k}\n" for k in range(11))
    (tmp_path / "decay.csv").write_text(f"t,x\n{rows}")
    (tmp_path / "decay.py").write_text(
        DECAY.replace("response(rate)", "response(rate, height)").replace("np.exp(", "height * np.exp(")
    )
    bounds = 'rate = { lower = 0.5, upper = 2.0 }\nheight = { lower = "1 m", upper = "1 m" }\n'
    study = f'[parameters]\n{bounds}[model]\nforward = "decay.py:decay"\n[data]\nfile = "decay.csv"\n'
    (tmp_path / "decay.toml").write_text(f'{study}columns = {{ x = "x" }}\n[identify]\n')
    ran = dalembert("run", "decay.toml")
    assert ran.returncode == 0
    assert re.search(r"\nheight +1 .*fixed\n", ran.stdout)
    best = json.loads((tmp_path / "runs/decay/state.json").read_text())["best"]
    assert best["values"] == {"rate": pytest.approx(1.2, abs=5e-3), "height": 1.0}
    assert list(best["deviations"]) == ["rate"]
    assert re.search(r"misfit \S+, rate = 1\.\d+, height = 1 ", dalembert("list").stdout)
    page = tmp_path / "runs/decay/report.html"
    page.unlink()
    assert dalembert("report", "decay").returncode == 0
    assert "<dt>height (m), fixed</dt><dd>1</dd>" in page.read_text(encoding="utf-8")


def test_a_study_from_a_template(dalembert, tmp_path):
    listed = dalembert("new").stdout.splitlines()
    assert listed[1].startswith("identify  Parameters from a measured motion: Identify the friction")
    assert listed[-1] == "Create a study with: dalembert new TEMPLATE FOLDER"
    begun = dalembert("new", "identify", "mine/rod")
    assert (begun.returncode, begun.stdout) == (0, "Run it with: dalembert run mine/rod/rod.toml\n")
    assert sorted(path.name for path in (tmp_path / "mine" / "rod").iterdir()) == [
        "motion.csv",
        "rod.toml",
        "study.schema.json",
    ]
    assert "valid; it identifies drag, angle" in dalembert("check", "mine/rod/rod.toml").stdout


def test_check(dalembert):
    checked = dalembert("check", "decay.toml")
    assert checked.returncode == 0
    first, second = checked.stdout.splitlines()
    assert first == "decay.toml: valid; it sweeps rate (4) at time 0.5 s: 4 simulations, each with 1 sensitivities"
    number = r"[\d.]+ (ms|s)"
    assert re.fullmatch(
        rf"This takes about {number}: 8 simulations of {number} \(4 at once at the first guesses\)\.", second
    )


def test_check_lists_the_channels_of_a_mechanism(dalembert, tmp_path):
    bar = 'kind = "RigidBar"\nname = "bar"\nlength = 1\nmass = 0.5\nangle = 0\n'
    (tmp_path / "bar.toml").write_text(f"[solver]\nstep = 0.1\n[simulate]\nend = 1\n[[model.body]]\n{bar}")
    lines = dalembert("check", "bar.toml").stdout.splitlines()
    assert lines[1:4] == [
        "30 channels, NAME.QUANTITY:",
        "  bar.start, bar.end, bar.centre: x, y, angle, vx, vy, rate, ax, ay, acceleration",
        "  system: kinetic_energy, potential_energy, total_energy",
    ]


def test_check_says_what_each_file_was_taken_to_be(dalembert, tmp_path):
    bar = 'kind = "RigidBar"\nname = "bar"\nlength = 1\nmass = "m"\nangle = 0\n'
    more = 'more = [{ file = "b.json", columns = { "bar.end.x" = "x" } }]\n'
    data = f'[data]\nfile = "a.txt"\ncolumns = {{ "bar.end.y" = "y" }}\n{more}'
    (tmp_path / "a.txt").write_text("Rig 7\nt;y\ns;mm\n0,0;1,5\n0,1;1,0\n0,2;0,5\n")
    (tmp_path / "b.json").write_text('{"t": [0.0, 0.15], "x": [1.0, 0.9]}')
    weights = '[identify]\nweights = { "bar.end.y" = 1.0, "bar.end.x" = 1.0 }\n'
    solver = "[parameters]\nm = { lower = 1, upper = 2 }\n[solver]\nstep = 0.1\n"
    (tmp_path / "bar.toml").write_text(f"{solver}{data}{weights}[[model.body]]\n{bar}")
    lines = dalembert("check", "bar.toml").stdout.splitlines()
    assert lines[1:3] == [
        "Data: a.txt: cells separated by semicolons, decimal commas, names in line 2, units in line 3",
        "Data: b.json: JSON",
    ]


def test_exit_code_1_if_the_solver_could_not(dalembert, tmp_path):
    (tmp_path / "decay.toml").write_text(SWEEP.replace("2 1/s", "3 1/s"))
    ran = dalembert("run", "decay.toml")
    assert ran.returncode == 1
    assert "rate. 4 points; 1 of them failed, see events.jsonl.\n" in ran.stdout
    assert "failed" in dalembert("list").stdout


@pytest.mark.parametrize("command", ["run", "check"])
def test_exit_code_2_if_the_input_is_wrong(dalembert, tmp_path, command):
    (tmp_path / "decay.toml").write_text(SWEEP.replace("lower", "lowwer").replace("at = 0.5", 'at = "0.5 X"'))
    ran = dalembert(command, "decay.toml")
    assert (ran.returncode, ran.stdout) == (2, "")
    assert ran.stderr.splitlines() == [
        "decay.toml: [parameters.rate]: the key 'lower' is missing",
        "decay.toml: [parameters.rate]: unknown key 'lowwer'; did you mean 'lower'?",
        "decay.toml: [sweep], at: '0.5 X' was given, but the unit 'X' is unknown; expected a number in SI units, "
        "or a number with its unit such as '400 mm'",
    ]
    assert not (tmp_path / "runs").exists()


def test_what_is_wrong_with_a_model_is_told_with_the_file_too(dalembert, tmp_path):
    bar = 'kind = "RigidBar"\nname = "bar"\nlength = 1\nmass = -0.5\nangle = 0\n'
    (tmp_path / "bar.toml").write_text(f"[solver]\nstep = 0.1\n[simulate]\nend = 1\n[[model.body]]\n{bar}")
    checked = dalembert("check", "bar.toml")
    assert (checked.returncode, checked.stdout) == (2, "")
    assert checked.stderr == "bar.toml: [model]: RigidBar 'bar': mass is -0.5 kg; expected a positive number\n"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["run", "dekay.toml"], "unknown study file 'dekay.toml'; did you mean 'decay.toml'?"),
        (["new", "identfy"], "unknown template 'identfy'; did you mean 'identify'?"),
        (["new", "identify", "."], ". is there already; name another folder for the study"),
        (["new", "motion", "decay.py/run"], "the folder decay.py/run cannot be made: Not a directory; name another"),
        (["report", "nothing"], "folder runs: unknown run 'nothing'; known: none. 'dalembert list' shows all"),
        (["resume", "runs/nothing"], "folder runs: unknown run 'nothing'; known: none. 'dalembert list' shows all"),
        (["report", "."], ". is no run folder: it has no state.json; name a run that 'dalembert list' shows"),
        (["run", "decay.toml", "--out", "decay.py"], "decay.py is a file; expected a folder for the run"),
        (
            ["run", "decay.toml", "--out", "decay.py/run"],
            "the run folder decay.py/run cannot be made: Not a directory; choose another with --out",
        ),
        (["run", "decay.toml", "--seed", "3"], "a seed was given, but [sweep] draws no random numbers; leave it out"),
    ],
)
def test_what_cannot_be_meant(dalembert, arguments, message):
    ran = dalembert(*arguments)
    assert (ran.returncode, ran.stdout, ran.stderr) == (2, "", message + "\n")


def test_usage_errors_are_input_errors(dalembert):
    assert dalembert("run").returncode == 2
    assert dalembert("runn", "decay.toml").returncode == 2


def test_list_of_nothing(dalembert):
    assert dalembert("list").stdout == "no runs in runs\n"


def test_schema_is_json(dalembert):
    shown = dalembert("schema")
    assert shown.returncode == 0
    assert json.loads(shown.stdout)["properties"].keys() >= {"study", "model", "parameters", "data"}


def test_version(dalembert):
    assert dalembert("--version").stdout == f"dalembert {__version__}\n"


def test_help_answers_at_once(dalembert):
    """Nothing heavy is imported on the way: it is that which would take seconds."""
    shown = dalembert("--help")
    assert shown.returncode == 0
    assert all(word in shown.stdout for word in ("run", "resume", "check", "list", "report", "schema"))
    code = "import sys, dalembert.cli; print(*sorted({'numpy', 'pydantic', 'numba', 'scipy'} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "\n"
