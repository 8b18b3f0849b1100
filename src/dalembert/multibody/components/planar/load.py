"""What acts without a constraint in the plane."""

__all__ = ["Load"]

from abc import abstractmethod
from dataclasses import dataclass

from dalembert.multibody.components.base_load import BaseLoad
from dalembert.multibody.components.rows import Lowering


@dataclass(frozen=True)
class Load(BaseLoad):
    """Base of all that acts without a constraint in the plane."""

    @abstractmethod
    def lower(self, lowering: Lowering) -> None:
        """Write the rows of the kernels."""
