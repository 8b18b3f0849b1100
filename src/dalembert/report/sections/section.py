"""What all sections of a report share."""

from dataclasses import dataclass
from typing import ClassVar

from jinja2 import Environment
from markupsafe import Markup

from dalembert.report.plot import Plot


@dataclass(frozen=True)
class Section:
    """A part of the page: a heading, its figures, and a template of the same name that lays them out."""

    name: ClassVar[str]
    heading: ClassVar[str]

    @property
    def anchor(self) -> str:
        """Where in the page the section is."""
        return self.heading.lower().replace(" ", "-")

    @property
    def plots(self) -> tuple[Plot, ...]:
        return ()

    def html(self, environment: Environment) -> Markup:
        """The section, rendered by ``<name>.html``."""
        return Markup(environment.get_template(f"{self.name}.html").render(section=self))
