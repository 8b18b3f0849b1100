"""The table of an integrator, of whichever kind."""

from functools import cache
from typing import Annotated, Any

from pydantic import AfterValidator

from dalembert.study.catalogue import catalogue, parts
from dalembert.study.components import buildable, one_of, table_of

DEFAULT = "GeneralizedAlpha"  # where a table names no kind


@cache
def solver() -> Any:
    """Type of a key that takes any integrator, checked by building it."""
    tables = [
        table_of(kind, default=kind.__name__ == DEFAULT, varying=False, parts=parts()) for kind in catalogue()["solver"]
    ]
    return Annotated[one_of(tables, DEFAULT), AfterValidator(buildable)]
