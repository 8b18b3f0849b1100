"""Settings of harmonic balance."""

from dataclasses import dataclass, replace

from dalembert.arguments import Checked, limited
from dalembert.errors import InputError, counted, require_known

AUTO = "auto"
"""Harmonics that are chosen by the truncation error, samples by the balance of forces."""
STIFFNESS, RECEPTANCE = "stiffness", "receptance"
SOLVERS = (AUTO, STIFFNESS, RECEPTANCE)
"""Ways to write the structure in the balance."""
MOST_HARMONICS = 1000
"""Far more than a friction contact needs; their tangents would fill the memory of any machine."""
MOST_PERIODS = 32
"""Periods of the excitation in a period of the motion."""
MOST_GIVEN = 1_000_000
"""Samples of a period, for the same reason."""
MOST_SAMPLES = 8192
"""Where the automatic doubling ends."""


@dataclass(frozen=True)
class HarmonicBalance(Checked):
    """Settings of harmonic balance.

    Parameters
    ----------
    harmonics : int or "auto"
        Highest harmonic. ``"auto"``: from ``least_harmonics`` on, H is raised to 2 H + 1 until the truncation error is
        below ``truncation``. One number holds for a whole curve, or for all parameters of a model.
    odd_only : bool
        Keep odd harmonics only: for motions that are their own opposite half a period later. Forces with a mean or
        even harmonics, such as those of stops and static forces, raise InputError.
    samples : int or "auto"
        Samples of a period at which the elements' forces are evaluated. ``"auto"``: doubled until twice as many change
        the balance of forces by less than ``sampling``.
    events : bool
        Whether contact and slip events between samples are found and the sums over samples corrected there, for stops
        and contacts; not for ``Rigid(prediction="velocity")`` in two directions. Without, a curve has a kink for each
        sample that changes its state.
    sampling : float
        Largest change, as part of the forces, for which samples are enough.
    tolerance : float
        Residual of a converged point, as part of the forces; by receptances, where residuals are displacements, as
        part of the motion of the contacts. Where rounding is larger, a residual of that size
        converges too, up to 1e-8.
    iterations : int
        Newton iterations of a point, at most. The step to a point that is not converged is halved.
    halvings : int
        Halvings of a step, after which the point is marked as not converged. With 0, a first point is not sought along
        a path over the force either.
    resolution : float
        Largest step of a curve that is followed from one frequency to another, as a fraction of their distance.
    truncation : float
        Largest truncation error of a motion, as part of it: 2.5 times the change of its largest amplitude with
        2 H + 1 harmonics. A larger one is the finding ``"few-harmonics"``.
    least_harmonics : int
        First number that ``harmonics="auto"`` tries. A force or an amplitude of a higher harmonic raises it.
    most_harmonics : int
        Largest number that ``harmonics="auto"`` tries.
    solver : {"auto", "stiffness", "receptance"}
        How the structure is written at the coordinates of contacts and springs. ``"stiffness"``: a dynamic stiffness,
        for each frequency. ``"receptance"``: the compliance and the modes of the structure whose contacts stick,
        computed once: for interfaces of many contacts. ``"auto"``: receptances where the
        contacts of a curve or a model have more than 500 unknowns, and the structure has more than 1500 degrees of
        freedom or a damping that couples no modes.
    periods : int
        Of the excitation in a period of the motion: 1, or more for subharmonic motions. Harmonics and samples are then
        those of the motion, ``harmonics`` · ``periods`` of them.

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

    The harmonics that a mass on a hardening spring needs:

    >>> import numpy as np
    >>> import dalembert as da
    >>> system = da.VibrationSystem(da.lumped({"m": 1.0}, [("m", None, 1.0, 0.02)]))
    >>> force, spring = system.add(da.HarmonicForce("m", 1.0)), system.add(da.CubicSpring("k3", "m", stiffness=0.5))
    >>> curve = da.frequency_response(system, np.array([0.05, 0.1]), HarmonicBalance(harmonics="auto"))
    >>> curve.orders[-1]
    7
    """

    harmonics: int | str = limited(9, least=1, most=MOST_HARMONICS)
    odd_only: bool = False
    samples: int | str = AUTO
    events: bool = True
    sampling: float = limited(1e-4, above=0, below=1)
    tolerance: float = limited(1e-10, above=0, below=1)
    iterations: int = limited(30, least=1)
    halvings: int = limited(6, least=0)
    resolution: float = limited(0.02, above=0, below=1)
    truncation: float = limited(5e-3, above=0, below=1)
    least_harmonics: int = limited(3, least=1, most=MOST_HARMONICS)
    most_harmonics: int = limited(127, least=1, most=MOST_HARMONICS)
    solver: str = AUTO
    periods: int = limited(1, least=1, most=MOST_PERIODS)

    def __post_init__(self) -> None:
        require_known("solver", self.solver, SOLVERS, "HarmonicBalance")
        if isinstance(self.harmonics, str) and self.harmonics != AUTO:
            raise InputError(f"HarmonicBalance: harmonics is {self.harmonics!r}; expected a whole number or 'auto'")
        if self.most_harmonics < self.least_harmonics:
            raise InputError(
                f"HarmonicBalance: most_harmonics is {self.most_harmonics}, less than least_harmonics, "
                f"{self.least_harmonics}. Raise most_harmonics"
            )
        most = self.most_harmonics if isinstance(self.harmonics, str) else self.harmonics
        needed = 2 * most * self.periods + 1
        if self.periods > 1 and self.odd_only:
            raise InputError(
                "HarmonicBalance: odd_only=True, but a motion of several periods has all harmonics. Use odd_only=False"
            )
        if isinstance(self.samples, str):
            if self.samples != AUTO:
                raise InputError(f"HarmonicBalance: samples is {self.samples!r}; expected a number or 'auto'")
        elif self.samples < needed:
            raise InputError(
                f"HarmonicBalance: samples is {self.samples}, too few for {most} harmonics. Use at least {needed}"
            )
        elif self.samples > MOST_GIVEN:
            raise InputError(
                f"HarmonicBalance: {self.samples} samples of a period were asked for; expected at most {MOST_GIVEN}"
            )

    @property
    def automatic(self) -> bool:
        """Whether the harmonics are chosen by the truncation error."""
        return isinstance(self.harmonics, str)

    @property
    def highest(self) -> int:
        """Highest harmonic.

        Raises
        ------
        InputError
            While it is not chosen.
        """
        if isinstance(self.harmonics, str):
            raise InputError("HarmonicBalance: harmonics is 'auto', which is not possible here. Give a number")
        return self.harmonics

    @property
    def words(self) -> str:
        """The number of harmonics, or how it is chosen, in words."""
        if not self.automatic:
            return counted(self.highest, "harmonic")
        return f"{self.least_harmonics} to {self.most_harmonics} harmonics, chosen by the truncation error"

    def refined(self) -> "HarmonicBalance | None":
        """Return the method with twice the harmonics and one more, and twice the samples; None beyond the limits."""
        harmonics = 2 * self.highest + 1
        samples = self.samples if isinstance(self.samples, str) else 2 * max(self.samples, harmonics + 1)
        if harmonics > MOST_HARMONICS or (isinstance(samples, int) and samples > MOST_GIVEN):
            return None
        return replace(self, harmonics=harmonics, samples=samples)

    def keeping(self, harmonic: int) -> "HarmonicBalance":
        """Return the method that keeps twice a harmonic and one more, if the number is chosen; else as it is."""
        return self.at_least(2 * harmonic + 1 if harmonic > 1 else 1)

    def at_least(self, harmonics: int) -> "HarmonicBalance":
        """Return the method that tries no fewer harmonics than these, if the number is chosen; else as it is."""
        if not self.automatic or harmonics <= self.least_harmonics:
            return self
        return replace(self, least_harmonics=harmonics, most_harmonics=max(self.most_harmonics, harmonics))

    def first(self) -> "HarmonicBalance":
        """Return the method with the first number of harmonics that is tried; as it is if the number is given."""
        return replace(self, harmonics=self.least_harmonics) if self.automatic else self

    def next(self) -> "HarmonicBalance | None":
        """Return the method with the number of harmonics that is tried next; None beyond the limit."""
        harmonics = 2 * self.highest + 1
        return replace(self, harmonics=harmonics) if harmonics <= self.most_harmonics else None

    @property
    def orders(self) -> tuple[int, ...]:
        """The harmonics kept, of the frequency of the motion."""
        return tuple(range(1, self.highest + 1, 2) if self.odd_only else range(self.highest * self.periods + 1))

    @property
    def first_samples(self) -> int:
        """Samples to begin with: a power of two, eight and more for the shortest wave, where they are chosen."""
        return self.samples if isinstance(self.samples, int) else max(64, 1 << (8 * self.orders[-1] - 1).bit_length())
