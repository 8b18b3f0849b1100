"""Studies with random mistakes: each is valid, or refused by a sentence, and soon."""

import random
import shutil
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
import tomlkit

from dalembert.errors import DalembertError
from dalembert.study import load, plan
from dalembert.study.template import begin, templates

SEEDS = 300
CHEAP = range(0, SEEDS, 25)
SECONDS = 10
"""Of processor time that a check may take."""
MOST_CHANGES = 3
NUMBERS = (0, -1, 1, -0.0, 1e-300, 1e300, float("nan"), float("inf"), 10**30, 2**63, 0.5, 1_000_000_000)
TEXTS = (
    "",
    " ",
    "0",
    "-1 m",
    "1 kg",
    "nan",
    "1e400 m",
    "a.b.c",
    "../x.csv",
    "x" * 1000,
    "π",
    "\x00",
    "[1, 2]",
    "ground",
)
VALUES = (*NUMBERS, *TEXTS, True, [], [[]], {}, [1, "a"], {"kind": "RigidBar"}, {"a": {"b": 1}}, "2020-01-01")


@pytest.fixture(scope="module")
def originals(tmp_path_factory) -> list[Path]:
    """The studies of all templates, without those that need a large mesh."""
    folder = tmp_path_factory.mktemp("templates")
    return [begin(name, folder / name) for name in sorted(templates())]


@contextmanager
def within_processor_time(seconds: float) -> Iterator[None]:
    def late(number: int, frame: object) -> None:
        raise AssertionError(f"the check took {seconds} s of processor time")

    former = signal.signal(signal.SIGVTALRM, late)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, former)


def places(tree: Any) -> list[tuple[Any, Any]]:
    """Each table or list with each of its keys."""
    found = []
    for key in list(tree) if isinstance(tree, dict) else range(len(tree)):
        found.append((tree, key))
        if isinstance(tree[key], dict | list):
            found += places(tree[key])
    return found


def mutated(document: dict[str, Any], draw: random.Random) -> dict[str, Any]:
    """A document with one to three random changes."""
    for _ in range(draw.randint(1, MOST_CHANGES)):
        if not (known := places(document)):
            break
        owner, key = draw.choice(known)
        other, place = draw.choice(known)
        match draw.randrange(6):
            case 0:
                del owner[key]
            case 1 | 2:
                owner[key] = draw.choice(VALUES)
            case 3:
                owner[key] = other[place] if not contains(other[place], owner) else 0
            case 4 if isinstance(owner, dict):
                owner[f"{key}{draw.choice(['s', '_', ' ', '2'])}"] = owner.pop(key)
            case _:
                number = isinstance(owner[key], int | float) and not isinstance(owner[key], bool)
                owner[key] = owner[key] * draw.choice([-1, 0, 1e6, 1e-6]) if number else [owner[key]]
    return document


def contains(tree: Any, wanted: Any) -> bool:
    if tree is wanted:
        return True
    inner = tree.values() if isinstance(tree, dict) else tree if isinstance(tree, list) else ()
    return any(contains(one, wanted) for one in inner)


def written(document: dict[str, Any], text: str, draw: random.Random) -> bytes:
    """The mutated document as text; of every tenth study the text itself is damaged instead."""
    if draw.random() < 0.1:
        content = bytearray(text.encode())
        for _ in range(draw.randint(1, 20)):
            content[draw.randrange(len(content))] = draw.randrange(256)
        return bytes(content[: draw.randrange(len(content))] if draw.random() < 0.5 else content)
    try:
        return tomlkit.dumps(mutated(document, draw)).encode()
    except Exception:  # tomlkit cannot write it, so it is no study
        return text.encode()[: draw.randrange(len(text))]


@pytest.mark.parametrize(
    "seed", [pytest.param(seed, marks=() if seed in CHEAP else pytest.mark.slow) for seed in range(SEEDS)]
)
def test_a_mutated_study_is_valid_or_refused_by_a_sentence(originals, tmp_path, seed):
    draw = random.Random(seed)
    original = draw.choice(originals)
    folder = tmp_path / "study"
    shutil.copytree(original.parent, folder)
    text = original.read_text(encoding="utf-8")
    path = folder / original.name
    path.write_bytes(written(tomlkit.parse(text).unwrap(), text, draw))
    with within_processor_time(SECONDS):
        answer = answered(path)
    assert answer.strip()
    assert "Traceback" not in answer


def answered(path: Path) -> str:
    """What a study does, or the sentence that refuses it."""
    try:
        return plan(load(path))
    except DalembertError as error:
        return str(error)
