"""The advice of findings as changes to a study: each can be shown before it is made."""

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import tomlkit
from tomlkit import TOMLDocument

from dalembert.errors import InputError
from dalembert.study.numbers import read_number

Values = Mapping[str, Any]
Best = Mapping[str, float]


@dataclass(frozen=True)
class Change:
    """A change to a study.

    Parameters
    ----------
    code : str
        Of the finding that advises it.
    label : str
        What it does, as the text of a button.
    apply : callable
        ``apply(document)`` changes a document of tomlkit. Comments and order stay.
    """

    code: str
    label: str
    apply: Callable[[TOMLDocument], None]


def changes_of(state: Mapping[str, Any], document: TOMLDocument) -> list[Change]:
    """Return the changes that the findings of a run advise, in their order.

    Parameters
    ----------
    state : mapping
        Of the run, as :meth:`~dalembert.study.folder.RunFolder.state` returns it.
    document : TOMLDocument
        The study of the run. It is not changed.
    """
    best = (state.get("best") or {}).get("values") or {}
    findings = [one for one in state.get("findings") or [] if "values" in one]
    return [change for one in findings for change in changes(one["code"], one["values"], document, best)]


def changes(code: str, values: Values, document: TOMLDocument, best: Best) -> list[Change]:
    """Return the changes that a finding advises; none where its advice is no change to this study.

    Parameters
    ----------
    code : str
    values : mapping
        Of the finding.
    document : TOMLDocument
    best : mapping
        Identified values by the names of their parameters, in SI units.

    Examples
    --------
    >>> document = tomlkit.parse('[solver] # implicit\\nstep = "1 ms" # fixed\\n')
    >>> (change,) = changes("integration-bias", {}, document, {})
    >>> change.apply(document)
    >>> change.label, tomlkit.dumps(document)
    ('Half the step: 0.5 ms', '[solver] # implicit\\nstep = "0.5 ms" # fixed\\n')
    """
    advise = _ADVICE.get(code)
    return [] if advise is None else [Change(code, *made) for made in advise(values, document, best)]


def start_from_best(document: TOMLDocument, best: Best) -> bool:
    """Make identified values the first guesses, within their bounds; return whether there are any to make.

    >>> document = tomlkit.parse('[parameters]\\nrate = { lower = 0.0, upper = 2.0 }\\n')
    >>> start_from_best(document, {"rate": 0.123456789}), tomlkit.dumps(document)
    (True, '[parameters]\\nrate = { lower = 0.0, upper = 2.0 , start = 0.12345679}\\n')
    """
    return False


_ADVICE: dict[str, Callable[[Values, TOMLDocument, Best], Iterator[tuple[str, Callable[[TOMLDocument], None]]]]] = {}
