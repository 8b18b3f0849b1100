"""The table of an integrator, of whichever kind."""

from functools import lru_cache
from typing import Annotated, Any

from pydantic import AfterValidator

from dalembert.study.catalogue import Words, kinds_of, part
from dalembert.study.components import buildable, one_of, table_of

DEFAULT = "GeneralizedAlpha"  # where a table names no kind


@lru_cache(maxsize=16)
def solver(words: Words = None) -> Any:
    """Type of a key that takes any integrator, or one that words name, checked by building it."""
    kinds = kinds_of("solver", None if words is None else words | {DEFAULT})
    tables = [table_of(kind, default=kind.__name__ == DEFAULT, varying=False, part=part) for kind in kinds]
    return Annotated[one_of(tables, DEFAULT), AfterValidator(buildable)]
