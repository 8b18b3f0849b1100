"""Settings of harmonic balance."""

from dataclasses import dataclass, replace

from dalembert.arguments import Checked, limited
from dalembert.errors import InputError

AUTOMATIC = "automatic"
MOST_HARMONICS = 1000
"""Far more than a friction contact needs; their tangents would fill the memory of any machine."""
MOST_GIVEN = 1_000_000
"""Samples of a period, for the same reason."""
MOST_SAMPLES = 8192
"""Where the automatic doubling ends."""


@dataclass(frozen=True)
class HarmonicBalance(Checked):
    """Settings of harmonic balance.

    Parameters
    ----------
    harmonics : int
        Highest harmonic.
    odd_only : bool
        Keep odd harmonics only: for motions that are their own opposite half a period later. Forces with a mean or
        even harmonics, such as those of stops and static forces, raise InputError.
    samples : int or "automatic"
        Samples of a period at which the elements' forces are evaluated. Automatic: doubled until twice as many change
        the balance of forces by less than ``sampling``.
    events : bool
        Whether contact and slip events between samples are found and the sums over samples corrected there, for stops
        and contacts; not for ``Rigid(kind="velocity")`` in two directions. Without, a curve has a kink for each sample
        that changes its state.
    sampling : float
        Largest change, as part of the forces, for which samples are enough.
    tolerance : float
        Residual of a converged point, as part of the forces. Where rounding is larger, a residual of that size
        converges too, up to 1e-8.
    iterations : int
        Newton iterations of a point, at most. The step to a point that is not converged is halved.
    halvings : int
        Halvings of a step, after which the point is marked as not converged. With 0, a first point is not sought along
        a path over the force either.
    resolution : float
        Largest step of a curve between two frequencies, as a fraction of their distance.

    Raises
    ------
    InputError
        For settings that make no sense, such as fewer samples than the harmonics need.

    Examples
    --------
    >>> HarmonicBalance(harmonics=3).orders, HarmonicBalance(harmonics=4, odd_only=True).orders
    ((0, 1, 2, 3), (1, 3))
    >>> HarmonicBalance(harmonics=9, samples=16)
    Traceback (most recent call last):
    dalembert.errors.InputError: HarmonicBalance: samples is 16, too few for 9 harmonics. Use at least 19
    """

    harmonics: int = limited(9, least=1, most=MOST_HARMONICS)
    odd_only: bool = False
    samples: int | str = AUTOMATIC
    events: bool = True
    sampling: float = limited(1e-4, above=0, below=1)
    tolerance: float = limited(1e-10, above=0, below=1)
    iterations: int = limited(30, least=1)
    halvings: int = limited(6, least=0)
    resolution: float = limited(0.02, above=0, below=1)

    def __post_init__(self) -> None:
        needed = 2 * self.harmonics + 1
        if isinstance(self.samples, str):
            if self.samples != AUTOMATIC:
                raise InputError(f"HarmonicBalance: samples is {self.samples!r}; expected a number or 'automatic'")
        elif self.samples < needed:
            raise InputError(
                f"HarmonicBalance: samples is {self.samples}, too few for {self.harmonics} harmonics. "
                f"Use at least {needed}"
            )
        elif self.samples > MOST_GIVEN:
            raise InputError(
                f"HarmonicBalance: {self.samples} samples of a period were asked for; expected at most {MOST_GIVEN}"
            )

    def refined(self) -> "HarmonicBalance | None":
        """Return the method with twice the harmonics and one more, and twice the samples; None beyond the limits."""
        harmonics = 2 * self.harmonics + 1
        samples = self.samples if isinstance(self.samples, str) else 2 * max(self.samples, harmonics + 1)
        if harmonics > MOST_HARMONICS or (isinstance(samples, int) and samples > MOST_GIVEN):
            return None
        return replace(self, harmonics=harmonics, samples=samples)

    @property
    def orders(self) -> tuple[int, ...]:
        """The harmonics kept."""
        return tuple(range(1, self.harmonics + 1, 2) if self.odd_only else range(self.harmonics + 1))

    @property
    def first_samples(self) -> int:
        """Samples to begin with: a power of two, eight and more for the shortest wave, where they are chosen."""
        return self.samples if isinstance(self.samples, int) else max(64, 1 << (8 * self.harmonics - 1).bit_length())
