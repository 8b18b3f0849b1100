"""What acts without a constraint, in the plane and in space."""

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from dalembert.arguments import Checked, is_number
from dalembert.findings import Finding
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
    def findings(self) -> tuple[Finding, ...]:
        """What there is to say about its numbers: a negative damping feeds energy."""
        damping = getattr(self, "damping", 0.0)
        if not (is_number(damping) and np.real(damping) < 0):
            return ()
        values = {"component": self.name, "damping": float(np.real(damping))}
        message = (
            f"{type(self).__name__} {self.name!r} has a negative damping, {values['damping']:g}. It feeds energy into "
            "the motion, which may grow without end."
        )
        return (Finding("negative-damping", "warning", values, message, "Check the sign of damping."),)

    @property
    def rotation_vector(self) -> tuple[str, ...]:
        """Channels of the rotation vector that its torque depends on, unique within half a turn; none for others."""
        return ()

    @abstractmethod
    def lower(self, lowering: Any) -> None:
        """Write the rows of the kernels."""
