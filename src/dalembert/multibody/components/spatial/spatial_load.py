"""What acts without a constraint in space."""

__all__ = ["Load"]

from abc import abstractmethod
from dataclasses import dataclass

from dalembert.multibody.components.base_load import BaseLoad
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows


@dataclass(frozen=True)
class Load(BaseLoad):
    """Base of all that acts without a constraint in space."""

    @abstractmethod
    def lower(self, lowering: SpatialRows) -> None:
        """Write the rows of the kernels."""
