"""Findings of a set inversion that the paving or the runs contradict."""

from types import SimpleNamespace

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.sets import set_findings


def test_a_coarse_surrogate_and_consistent_runs_outside_are_named(monkeypatch):
    unseen = Finding("unseen-features", "note", {}, "Narrow features are not excluded.")
    monkeypatch.setattr(set_findings, "unseen", lambda *_: unseen)
    surrogate = SimpleNamespace(error=np.array([3.0]), slow_directions=lambda error: [1])
    inversion = SimpleNamespace(first=None, error=np.array([1.0]))
    paving = SimpleNamespace(hull=None)
    first, coarse, missed = set_findings.conclusions(inversion, surrogate, paving, np.zeros((2, 2)), ["p0", "p1"])
    assert (first.code, first.message.startswith("The set may have a component")) == (unseen.code, True)
    assert (coarse.code, coarse.severity) == ("coarse-surrogate", "warning")
    assert coarse.values == {"share": 3.0, "directions": "p1"}
    assert "The coefficients do not decay along 'p1', as at a kink or a step." in coarse.message
    assert (missed.code, missed.severity, missed.values) == ("missed-component", "error", {"runs": 2})
    assert missed.message == "2 consistent runs lie outside of the set: the surrogate misses a component."
    assert missed.advice == "Give a scheme with a smaller tolerance, or bounds close around the component."
