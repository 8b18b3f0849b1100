"""Doors from results to what shows them."""

from types import SimpleNamespace

import pytest

from dalembert import hooks
from dalembert.errors import InputError


def test_each_door_leads_to_a_function_that_is_there():
    for name in hooks.ENTRIES:
        assert callable(hooks.hook(name))


def test_a_door_imports_only_when_it_is_used(monkeypatch):
    asked = []
    monkeypatch.setattr(hooks, "import_module", lambda name: asked.append(name) or SimpleNamespace(report="door"))
    assert asked == []
    assert hooks.hook("report") == "door"
    assert asked == ["dalembert.report"]


def test_an_unknown_door_is_answered_with_the_nearest():
    with pytest.raises(InputError) as error:
        hooks.hook("reports")
    assert str(error.value) == "unknown hook 'reports'; did you mean 'report'?"
