"""Findings: kept with a result, printed, and a reason to doubt it."""

import json
from dataclasses import replace

import pytest

from dalembert import Finding, identify, identify_bands, identify_set, predict, profile, propagate
from dalembert.report import report
from small_models import LINE, banded, measured

WARNING = Finding("few-samples", "warning", {"samples": 3}, "The record has 3 samples.", "Use a longer record.")
NOTE = Finding("surrogate-used", "note", {}, "A polynomial replaced the model.")

DATA = measured(LINE, [1.0, 2.0], 0.01, deviations=0.01)
FIT = identify(LINE, DATA)
RESULTS = {
    "fit": FIT,
    "profiles": profile(LINE, DATA, FIT, names=["slope"]),
    "prediction": predict(LINE, FIT),
    "set": identify_set(LINE, DATA, error=0.1),
    "bands": identify_bands(LINE, banded(LINE, [0.9, 1.9], [1.1, 2.1])),
    "bounds": propagate(LINE, {"offset": (0.0, 1.0), "slope": (1.0, 2.0)}),
}


@pytest.fixture(params=RESULTS.values(), ids=RESULTS)
def result(request):
    return replace(request.param, findings=(WARNING, NOTE))


def test_a_file_keeps_them(result, tmp_path):
    result.save(tmp_path / "result.nc")
    assert type(result).load(tmp_path / "result.nc").findings == (WARNING, NOTE)


def test_a_dataset_of_a_version_without_them_has_none(result):
    dataset = result.to_xarray()
    settings = json.loads(dataset.attrs["settings"])
    assert len(settings.pop("findings")) == 2
    dataset.attrs["settings"] = json.dumps(settings)
    assert type(result).from_xarray(dataset).findings == ()


def test_a_summary_ends_with_their_messages_and_advice(result):
    assert result.summary().endswith("The record has 3 samples. Use a longer record.\nA polynomial replaced the model.")


def test_a_warning_is_a_reason_to_doubt_and_a_note_is_not(result):
    assert WARNING in result.doubts
    assert NOTE not in result.doubts


def test_a_report_shows_them_below_the_status(result, tmp_path):
    report(result, tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert '<p class="verdict doubtful">' in page
    assert '<li class="warning-finding">The record has 3 samples. <span>Use a longer record.</span></li>' in page
    assert '<li class="note-finding">A polynomial replaced the model.</li>' in page
