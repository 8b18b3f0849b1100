"""One mistake is one sentence, also where a key takes several forms."""

import pytest

from dalembert.errors import InputError
from dalembert.study import load

HEAD = """
[parameters]
a = { lower = -2.0, upper = 2.0 }
[model]
forward = "models.py:line"
[data]
file = "x.csv"
columns = { x = "x" }
[identify.noise]
model = "autoregressive"
"""


@pytest.mark.parametrize(
    ("key", "sentence"),
    [
        ('deviation = "abc"', "[identify.noise], deviation: 'abc' was given, but unknown name 'abc'"),
        ("deviation = { model = 'abc' }", "[identify.noise.deviation], model: 'abc' was given; expected 'known'"),
        ("deviation = { modell = 'constant' }", "[identify.noise.deviation]: unknown key 'modell'"),
        ('deviation = [1, "3 abc"]', "[identify.noise], deviation, entry 2: '3 abc' was given"),
        ('time = "3 m"', "[identify.noise], time: '3 m' was given; expected a time"),
    ],
)
def test_only_the_form_that_was_written_is_refused(key, sentence, tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(f"{HEAD}{key}\n")
    with pytest.raises(InputError) as refused:
        load(path)
    (line,) = (line for line in str(refused.value).splitlines() if "noise" in line)
    assert sentence in line
