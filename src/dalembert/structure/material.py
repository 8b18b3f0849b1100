"""Elastic materials."""

from dataclasses import dataclass, field

from dalembert.arguments import Checked
from dalembert.ranges import POSITIVE, Range


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

    youngs_modulus: float | complex = field(metadata={"unit": "Pa", "range": POSITIVE})
    poisson_ratio: float | complex = field(metadata={"range": Range(above=-1.0, below=0.5)})
    density: float | complex = field(metadata={"unit": "kg/m^3", "range": POSITIVE})

    @property
    def lame(self) -> tuple[float | complex, float | complex]:
        """Lamé's constants λ and μ, Pa."""
        modulus, ratio = self.youngs_modulus, self.poisson_ratio
        return modulus * ratio / ((1 + ratio) * (1 - 2 * ratio)), modulus / (2 * (1 + ratio))
