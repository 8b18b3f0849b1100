"""From a data file to the table of data of a draft, without a page."""

import asyncio
import tomllib
from dataclasses import replace

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.studio.data.columns import uses
from dalembert.studio.data.guide import DataGuide
from dalembert.studio.data.picker import columns_figure, drawn_columns
from dalembert.studio.editor.draft import Draft
from dalembert.studio.editor.reading import reading
from dalembert.studio.worker import Kept
from dalembert.study.template import begin

ANGLE = "rod.start.angle"


class Here:
    """Computes in this process what a worker computes in another one."""

    def __init__(self):
        self.kept = Kept()

    async def ask(self, subject, function, *arguments):
        return function(self.kept, *arguments)


@pytest.fixture
def guide(tmp_path):
    """A guide of the study of a pendulum, with a record of angles from the vertical beside it."""
    draft = Draft(begin("identify", tmp_path / "pendulum"))
    draft.check()
    times = np.arange(0, 4, 0.02)
    angles = 40 * np.exp(-0.1 * times) * np.cos(4.3 * times)
    rows = [f"{1500 + 1000 * time:.0f} {angle:.3f}" for time, angle in zip(times, angles, strict=True)]
    (draft.path.parent / "own.txt").write_text("\n".join(["time_ms angle_deg", *rows]))
    return DataGuide(draft, Here())


def looked(guide):
    asyncio.run(guide.look())
    asyncio.run(guide.doubt())
    return guide


def test_the_study_has_its_own_choices_first(guide):
    assert guide.follow()
    assert guide.files == ["motion.csv", "own.txt"]
    looked(guide)
    assert (guide.is_written, guide.is_reading, guide.findings, guide.error) == (True, False, (), "")
    assert not guide.follow()


def test_a_file_is_mapped_written_and_its_offset_estimated(guide):
    guide.follow()
    guide.choose_file("own.txt")
    assert guide.is_reading
    looked(guide)
    with pytest.raises(InputError, match="No column is used for a channel"):
        guide.write()
    guide.choices = guide.choices.mapped(ANGLE, "angle_deg")
    with pytest.raises(InputError, match="No column is used for a channel"):
        guide.write()
    looked(guide)
    assert [finding.code for finding in guide.findings] == ["late-times", "suspect-offset"]
    assert [guide.remedy(finding) for finding in guide.findings] == ["", "Estimate the offset"]
    guide.apply(guide.findings[1])
    tables = tomllib.loads(guide.draft.text)
    assert tables["data"]["columns"] == {ANGLE: "angle_deg"}
    assert list(tables["sensors"]) == [ANGLE]
    assert guide.is_written
    guide.draft.check()
    assert guide.draft.mistakes == ()
    assert [finding.code for finding in looked(guide).findings] == ["late-times"]


def test_words_and_numbers_for_missing_values_are_no_wrong_cells(guide):
    rows = [f"{k / 50},{k % 7}" for k in range(200)]
    rows[20], rows[30] = "0.4,dropout", "0.6,-9999"
    (guide.draft.path.parent / "own.csv").write_text("\n".join(["t,angle", *rows]))
    guide.follow()
    guide.choose_file("own.csv")
    looked(guide)
    guide.choices = replace(guide.choices.mapped(ANGLE, "angle"), missing=["DROPOUT", -9999])
    looked(guide)
    assert {finding.code for finding in guide.findings}.isdisjoint({"no-number", "missing-values", "outliers"})
    curve = next(curve for curve in guide.examined.curves if curve.key == "angle")
    assert (curve.missing, np.nanmin(curve.values)) == (2, 0.0)
    guide.choices = replace(guide.choices, missing=[-9999])
    looked(guide)
    wrong = next(finding for finding in guide.findings if finding.code == "no-number")
    assert (wrong.values["line"], guide.remedy(wrong)) == (22, "Take it as a missing value")
    guide.apply(wrong)
    looked(guide)
    assert guide.choices.missing == ["-9999", "dropout"]
    assert "no-number" not in [finding.code for finding in guide.findings]


def test_a_file_without_times_has_a_sampling_rate(guide):
    rows = [f"{40 * np.cos(4.3 * k / 50):.3f}" for k in range(200)]
    (guide.draft.path.parent / "own.csv").write_text("\n".join(["angle_deg", *rows]))
    guide.follow()
    guide.choose_file("own.csv")
    looked(guide)
    guide.choices = guide.choices.mapped(ANGLE, "angle_deg")
    looked(guide)
    with pytest.raises(InputError, match="or give the sampling rate"):
        guide.write()
    guide.choices = replace(guide.choices, sampling=50.0)
    looked(guide)
    assert guide.examined.curves[0].along[-1] == pytest.approx(199 / 50)
    guide.write()
    data = tomllib.loads(guide.draft.text)["data"]
    assert (data["sampling"], "time" in data) == (50.0, False)
    guide.draft.check()


def test_outliers_are_fitted_by_a_robust_loss(guide):
    guide.follow()
    file = guide.draft.path.parent / "own.txt"
    lines = file.read_text().splitlines()
    lines[80] = lines[80].split()[0] + " 3000.0"
    file.write_text("\n".join(lines))
    guide.choose_file("own.txt")
    looked(guide)
    guide.choices = guide.choices.mapped(ANGLE, "angle_deg")
    looked(guide)
    remedies = {finding.code: guide.remedy(finding) for finding in guide.findings}
    assert remedies == {
        "late-times": "", "outliers": "Use a robust loss", "suspect-offset": "Estimate the offset"
    }  # fmt: skip
    outlier = next(finding for finding in guide.findings if finding.code == "outliers")
    guide.apply(outlier)
    identify = tomllib.loads(guide.draft.text)["identify"]
    assert identify["loss"] == "huber"
    assert 0 < identify["loss_scale"] < 1e-3  # rad; the angles are rounded to thousandths of a degree
    guide.draft.check()
    assert guide.draft.mistakes == ()
    assert guide.remedy(outlier) == ""


@pytest.mark.parametrize("head", ["angle [°]", "angle (°)"])
def test_a_column_in_degrees_by_their_sign_fits_angles(guide, head):
    guide.follow()
    (guide.draft.path.parent / "sign.csv").write_text(f"t [s],{head}\n" + "".join(f"{k},{k}\n" for k in range(9)))
    guide.choose_file("sign.csv")
    curve = looked(guide).examined.curves[1]
    assert curve.unit.name == "°"
    first = list(uses(guide.examined.channels, curve.unit.name))[2]
    assert guide.examined.channels[first] == "rad"


def test_a_wrong_unit_is_put_right(guide):
    guide.follow()
    guide.choose_file("own.txt")
    looked(guide)
    guide.choices = guide.choices.mapped(ANGLE, "angle_deg").with_unit("angle_deg", "rad")
    looked(guide)
    suspect = next(finding for finding in guide.findings if finding.code in ("suspect-degrees", "suspect-unit"))
    assert guide.remedy(suspect) == "Use deg"
    guide.apply(suspect)
    assert guide.choices.units["angle_deg"] == "deg"


def test_a_file_that_cannot_be_read_is_a_sentence(guide):
    (guide.draft.path.parent / "empty.csv").write_text("a,b\nc,d\n")
    guide.choose_file("empty.csv")
    looked(guide)
    assert guide.error == "empty.csv: the file has no line of numbers; expected column names and then lines of numbers"
    assert not guide.is_reading
    with pytest.raises(InputError, match="Choose a data file first"):
        guide.write()


def test_columns_are_drawn_without_the_times(guide):
    guide.follow()
    guide.choose_file("own.txt")
    looked(guide)
    assert [curve.key for curve in drawn_columns(guide.examined)] == ["angle_deg"]
    figure = columns_figure(guide.examined)
    assert [trace.name for trace in figure.data] == ["angle_deg"]
    assert figure.data[0].x[0] == 0.0


def test_the_channels_of_a_model_file_that_changed_are_those_that_it_has_now(guide):
    draft = guide.draft
    head, _, rest = draft.text.partition("[model]")
    model, at, task = f"[model]{rest}".partition("[solver]")
    other = draft.path.with_name("pendulum.toml")
    other.write_text(model)
    draft.set_text(f'{head}[model]\nfile = "pendulum.toml"\n{at}{task}')
    kept = guide._worker.kept
    draft.take(reading(kept, draft.path, draft.text))
    guide.follow()
    assert "rod.end.x" in looked(guide).examined.channels
    other.write_text(model.replace('"rod"', '"bar"').replace("rod.", "bar."))
    draft.take(reading(kept, draft.path, draft.text))
    assert "bar.end.x" in looked(guide).examined.channels
