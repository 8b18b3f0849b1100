"""How results and models show themselves in Jupyter and marimo: as HTML, made only when it is asked for."""

from pkgutil import resolve_name
from typing import ClassVar

from dalembert.errors import DalembertError


class Displayed:
    """Base of what a notebook shows as drawing, key values and figure."""

    NOTEBOOK: ClassVar[str] = "dalembert.report.notebook:html_of"
    """Function that returns the HTML, imported when it is called."""

    def _repr_html_(self) -> str | None:
        """HTML for notebooks; None, for the plain text, where there is nothing more to show."""
        try:
            return resolve_name(self.NOTEBOOK)(self)
        except DalembertError:  # a model that cannot be assembled yet, for example
            return None
