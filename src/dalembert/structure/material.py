"""Elastic materials."""

from dataclasses import dataclass, field

from dalembert.arguments import Checked
from dalembert.errors import InputError


@dataclass(frozen=True)
class Material(Checked):
    """An isotropic elastic material.

    Parameters
    ----------
    youngs_modulus : float
        Pa, positive. This and the others may be complex, with a complex step as their imaginary part.
    poisson_ratio : float
        Above -1 and below 0.5.
    density : float
        kg/m³, positive.

    Raises
    ------
    InputError
        For a number out of its range.

    Examples
    --------
    >>> Material(200e9, 0.25, 7800.0).lame  # λ and μ, Pa
    (80000000000.0, 80000000000.0)
    """

    youngs_modulus: float | complex = field(metadata={"unit": "Pa"})
    poisson_ratio: float | complex
    density: float | complex = field(metadata={"unit": "kg/m^3"})

    def __post_init__(self) -> None:
        for name, unit in (("youngs_modulus", " Pa"), ("density", " kg/m³")):
            if not getattr(self, name).real > 0:
                raise InputError(f"Material: {name} is {getattr(self, name)}{unit}; expected a positive number")
        if not -1 < self.poisson_ratio.real < 0.5:
            raise InputError(
                f"Material: poisson_ratio is {self.poisson_ratio}; expected a number above -1 and below 0.5"
            )

    @property
    def lame(self) -> tuple[float | complex, float | complex]:
        """Lamé's constants λ and μ, Pa."""
        modulus, ratio = self.youngs_modulus, self.poisson_ratio
        return modulus * ratio / ((1 + ratio) * (1 - 2 * ratio)), modulus / (2 * (1 + ratio))
