"""Parts of an identification that do not depend on each other, prefetched from a cluster."""

from collections.abc import Callable, Generator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, TypeVar, cast

from dalembert import forward
from dalembert.forward import ForwardModel
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import Problem

Item = TypeVar("Item")
Work = Callable[[Problem, Item], object]


def prefetched(problem: Problem, work: Work[Item], items: Sequence[Item]) -> Generator[Item, None, None]:
    """The items, in their order; where the problem's model is on a cluster, answers for work on each come first.

    ``work`` is called on the workers with a problem that tells nobody of its events.
    """
    alone = replace(problem, model=cast(Any, None), journal=Journal(problem.samples))
    return forward.prefetched(problem.model, partial(_posed, alone, work), items)


def _posed(alone: Problem, work: Work[Item], model: ForwardModel, item: Item) -> None:
    work(replace(alone, model=model), item)
