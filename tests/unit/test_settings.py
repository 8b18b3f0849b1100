"""Settings of methods that are refused, in whole sentences."""

import re
from dataclasses import dataclass

import numpy as np
import pytest
from tests.support import says

from dalembert.errors import InputError
from dalembert.settings import expect, expect_at_least, expect_positive


@dataclass(frozen=True)
class Method:
    step: float = 0.1
    runs: int = 5


def test_settings_that_hold_are_left_alone():
    method = Method()
    expect_at_least(method, 5, "runs")
    expect_positive(method, "step", "runs")
    expect(method, "a number below 6", lambda given: given < 6, "step", "runs")


def test_the_sentence_names_the_method_the_setting_and_what_was_given():
    with pytest.raises(InputError, match=says("Method: runs is 1; expected at least 2")):
        expect_at_least(Method(runs=1), 2, "runs")
    with pytest.raises(InputError, match=says("Method: step is 0; expected a positive number")):
        expect_positive(Method(step=0), "runs", "step")


@pytest.mark.parametrize("check", [expect_positive, lambda method, name: expect_at_least(method, 1, name)])
def test_no_number_is_no_setting(check):
    with pytest.raises(InputError, match=re.escape("Method: step is nan; expected ")):
        check(Method(step=np.nan), "step")
