"""What acts without a constraint."""

__all__ = ["Load"]

from abc import abstractmethod
from dataclasses import dataclass
from typing import ClassVar

from dalembert.arguments import Checked
from dalembert.multibody.components.lowering import Lowering
from dalembert.multibody.kernels.kind import Kind


@dataclass(frozen=True)
class Load(Checked):
    """Base of all that acts without a constraint."""

    name: str

    kind: ClassVar[Kind]

    @abstractmethod
    def lower(self, lowering: Lowering) -> None:
        """Write the rows of the kernels."""
