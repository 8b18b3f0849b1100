"""How columns are to be used, and the `[data]` table that says so."""

import tomllib
from dataclasses import replace

import pytest
import tomlkit

from dalembert.data.preview import preview
from dalembert.data.problems import problems
from dalembert.errors import InputError
from dalembert.studio.data.choices import Choices, fix_of, guessed, of_table, table_of, write
from dalembert.study.template import templates

ANGLE = "rod.start.angle"
CHANNELS = {ANGLE: "rad", "rod.end.x": "m"}
IDENTIFY = templates()["identify"]


@pytest.fixture
def own(tmp_path):
    """A file as an engineer has it: blanks, degrees, milliseconds, times not from 0."""
    (tmp_path / "own.txt").write_text("time_ms angle_deg\n1500 20.5\n1510 20.25\n1520 20\n")
    return preview(tmp_path / "own.txt")


def written(found, choices, text=IDENTIFY.text, place=("data",)):
    document = tomlkit.parse(text)
    write(document, table_of(choices, found), place)
    return tomlkit.dumps(document)


def test_guesses_and_one_choice_give_the_table(own):
    choices = guessed(own, CHANNELS)
    assert choices == Choices("own.txt", "time_ms", start="first")
    assert table_of(choices.mapped(ANGLE, "angle_deg"), own) == {
        "file": "own.txt",
        "time": "time_ms",
        "columns": {ANGLE: "angle_deg"},
        "units": {"time_ms": "ms", "angle_deg": "deg"},
        "start": "first",
    }


def test_a_column_is_used_for_the_channel_of_its_name(tmp_path):
    (tmp_path / "own.csv").write_text("t,rod.end.x\n0,1\n1,\n")
    choices = guessed(preview(tmp_path / "own.csv"), CHANNELS)
    assert choices.channels == {"rod.end.x": "rod.end.x"}
    assert (choices.start, choices.missing) == (None, "leave-out")


def test_numbers_of_columns_and_units_that_the_file_names(tmp_path):
    (tmp_path / "own.csv").write_text("t,a,a\ns,deg,mm\n0,1,2\n1,2,3\n")
    found = preview(tmp_path / "own.csv")
    choices = guessed(found, CHANNELS).mapped(ANGLE, 2).mapped("rod.end.x", 3)
    assert table_of(choices, found) == {"file": "own.csv", "columns": {ANGLE: 2, "rod.end.x": 3}}
    other = replace(choices, units={2: "rad", 3: "cm"})
    assert table_of(other, found)["units"] == {"2": "rad", "3": "cm"}


def test_si_units_of_columns_whose_names_end_in_another_unit_are_written(own):
    choices = guessed(own, CHANNELS).mapped(ANGLE, "angle_deg").with_unit("angle_deg", "rad")
    assert table_of(choices, own)["units"] == {"time_ms": "ms", "angle_deg": "rad"}


def test_nothing_is_written_without_times_or_channels(own):
    with pytest.raises(InputError, match="No column is used for a channel"):
        table_of(guessed(own, CHANNELS), own)
    with pytest.raises(InputError, match="No column has the times"):
        table_of(Choices("own.txt", channels={ANGLE: "angle_deg"}), own)


def test_writing_keeps_comments_order_and_other_keys(own):
    text = IDENTIFY.text.replace('file = "motion.csv"', 'every = 2\nmissing = "refuse" # so far\nfile = "motion.csv"')
    after = written(
        own, guessed(own, CHANNELS).mapped(ANGLE, "angle_deg"), text.replace("[data]", "# mine\n[data] # here")
    )
    assert "# mine\n[data] # here\nfile" in after
    assert after.startswith(IDENTIFY.text[: IDENTIFY.text.index("[data]")])
    assert tomllib.loads(after)["data"].keys() == {"file", "columns", "time", "units", "start"}
    assert after.index("[data]") < after.index('start = "first"') < after.index("[identify]")


def test_the_same_choices_change_nothing(own):
    choices = guessed(own, CHANNELS).mapped(ANGLE, "angle_deg")
    once = written(own, choices)
    assert written(own, choices, once) == once
    again = of_table(tomllib.loads(once)["data"])
    assert table_of(again, own) == table_of(choices, own)


def test_keys_of_the_same_file_stay_and_deviations_go_with_their_channels(own):
    choices = guessed(own, CHANNELS).mapped(ANGLE, "angle_deg")
    text = written(own, choices).replace(
        'start = "first"\n', f'start = "first"\nevery = 2\ndeviations = {{ "{ANGLE}" = 0.1 }}\n'
    )
    assert tomllib.loads(written(own, choices, text))["data"]["deviations"] == {ANGLE: 0.1}
    other = tomllib.loads(written(own, choices.mapped(ANGLE, None).mapped("rod.end.x", "angle_deg"), text))["data"]
    assert "deviations" not in other
    assert other["every"] == 2


def test_a_study_without_data_and_an_experiment_are_written(own):
    choices = guessed(own, CHANNELS).mapped(ANGLE, "angle_deg")
    assert tomllib.loads(written(own, choices, "[identify]\nstarts = 4\n"))["data"]["file"] == "own.txt"
    text = '[[experiments]]\nname = "a"\n[[experiments]]\nname = "b"\n'
    experiments = tomllib.loads(written(own, choices, text, ("experiments", 1)))["experiments"]
    assert [table.get("file") for table in experiments] == [None, "own.txt"]


def test_choices_of_a_table_know_numbers_of_columns():
    table = {"file": "a.txt", "time": 1, "columns": {ANGLE: 2}, "units": {"1": "ms", "2": "deg"}, "between": [0, 2.5]}
    choices = of_table(table)
    assert (choices.units, choices.between) == ({1: "ms", 2: "deg"}, (0, 2.5))
    assert of_table({"file": "a.txt", "between": ["now", "2 s"]}).between is None


FIXED = {
    "late-times": "t,x\n1,0\n2,1\n3,0\n",
    "missing-values": "t,x\n0,0\n1,\n2,0\n",
    "angle-jumps": "t,x\n0,3.1\n1,-3.1\n2,-3\n",
    "suspect-degrees": "t,x\n0,30\n1,-33\n2,-34\n",
    "samples-before-start": "t,x\n-1,3.1\n0,3\n1,2.9\n",
    "many-samples": "t,x\n" + "".join(f"{row / 1000},{row % 2}\n" for row in range(20_001)),
}


@pytest.mark.parametrize("code", FIXED)
def test_a_button_puts_a_problem_right(tmp_path, code):
    (tmp_path / "own.csv").write_text(FIXED[code])
    found = preview(tmp_path / "own.csv")
    choices = Choices("own.csv", "t", channels={ANGLE: "x"})
    (finding,) = [one for one in problems(found, choices.use(found, CHANNELS)) if one.code == code]
    fixed = fix_of(finding).change(choices, finding.values)
    left = problems(found, fixed.use(found, CHANNELS))
    assert [one for one in left if one.code == code and one.severity != "note"] == []
    assert [fix_of(one) for one in left if one.code == code] in ([], [None])


def test_missing_times_have_no_button(tmp_path):
    (tmp_path / "own.csv").write_text("t,x\n0,0\n,1\n2,0\n")
    found = preview(tmp_path / "own.csv")
    use = Choices("own.csv", "t", channels={ANGLE: "x"}).use(found, CHANNELS)
    assert [fix_of(finding) for finding in problems(found, use)] == [None]


def test_times_with_their_unit_stay_as_they_were_written(own):
    table = {"file": "own.txt", "time": "time_ms", "columns": {ANGLE: "angle_deg"}, "start": "1510 ms"}
    table |= {"between": ["1.5 s", "2 s"]}
    choices = of_table(table)
    assert (choices.begin, choices.use(own, CHANNELS).start, choices.use(own, CHANNELS).between) == (
        1.51,
        1.51,
        (1.5, 2),
    )
    assert (table_of(choices, own)["start"], table_of(choices, own)["between"]) == ("1510 ms", ["1.5 s", "2 s"])


def test_ranges_of_frequencies_stay_as_they_were_written(own):
    choices = of_table({"file": "own.txt", "columns": {ANGLE: "angle_deg"}, "between": ["10 Hz", "20 Hz"]})
    assert choices.use(own, CHANNELS).between is None
    assert table_of(choices, own)["between"] == ["10 Hz", "20 Hz"]
