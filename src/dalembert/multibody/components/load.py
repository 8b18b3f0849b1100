"""What acts without a constraint, in the plane and in space."""

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar

from dalembert.arguments import Checked
from dalembert.multibody.kernels.kind import Kind


@dataclass(frozen=True)
class BaseLoad(Checked):
    """Base of all that acts without a constraint."""

    name: str

    kind: ClassVar[Kind]

    @property
    def coordinates(self) -> tuple[Any, ...]:
        """Bodies without mass, one for each coordinate of a joint that the component needs."""
        return ()

    @property
    def rotation_vector(self) -> tuple[str, ...]:
        """Channels of the rotation vector that its torque depends on, unique within half a turn; none for others."""
        return ()

    @abstractmethod
    def lower(self, lowering: Any) -> None:
        """Write the rows of the kernels."""
