"""Which features of a function its surrogate cannot exclude, as a finding."""

from collections.abc import Sequence

import numpy as np

from dalembert.findings import Finding
from dalembert.surrogate.gaps import Gaps, gaps
from dalembert.surrogate.powers_of_two import powers_of_two
from dalembert.surrogate.surrogate import Surrogate

# Part of the scale below which an output does not count for the lengths over which the response varies.
SIGNIFICANT = 0.1
FEATURE = "bump, pit or step"


def unseen(surrogate: Surrogate, names: Sequence[str]) -> Finding:
    """Return the finding "unseen-features": the width below which a feature can lie between the runs.

    A note, and a warning where the runs are farther apart than the response varies, or where no run tested the
    surrogate.

    Parameters
    ----------
    names : sequence of str, of length d
        Of the directions.
    """
    polynomial = surrogate.polynomial
    free = np.flatnonzero(polynomial.upper > polynomial.lower)
    if not len(free):
        return Finding("unseen-features", "note", {"gap": 0.0}, "The box has no width.")
    empty = gaps(polynomial.eta(surrogate.points)[:, free], variation_lengths(surrogate)[free])
    message, values = _told(empty, [names[int(k)] for k in free], surrogate.runs)
    if not surrogate.tested:
        message += " No held-out run tested the surrogate."
        return Finding("unseen-features", "warning", values, message, "Set held_out to at least 10.")
    if empty.relative > 1:
        message += " The response varies over shorter lengths than that."
        return Finding("unseen-features", "warning", values, message, "Increase held_out, or make the box smaller.")
    return Finding("unseen-features", "note", values, message, "Increase held_out if the response may have one.")


def unseen_between(eta: np.ndarray, names: Sequence[str]) -> tuple[str, dict[str, float | int]]:
    """Return the sentence and the values for runs at coordinates η (runs, f) of named directions."""
    return _told(gaps(eta), names, len(eta))


def variation_lengths(surrogate: Surrogate) -> np.ndarray:
    """Return half a wave of the response along each direction as a part of its side, shape (d,); at most 1.

    T_n has n half waves. Of each output that matters the mean degree √(Σ e_k² c² / Σ c²) counts, and of all outputs the
    largest one.
    """
    polynomial = surrogate.polynomial
    varying = polynomial.exponents.any(axis=1)
    exponents, coefficients = polynomial.exponents[varying], polynomial.coefficients[varying]
    powers = powers_of_two(coefficients)  # the squares of large outputs would overflow
    squares = np.ldexp(coefficients, -powers) ** 2
    total = squares.sum(axis=0)
    matters = np.sqrt(total) > np.ldexp(SIGNIFICANT * surrogate.scale / 2, -powers)
    if not matters.any():
        return np.ones(len(polynomial.lower))
    degrees = np.sqrt((exponents**2).T @ squares[:, matters] / total[matters])
    return 1 / np.maximum(degrees.max(axis=1), 1.0)


def _told(empty: Gaps, names: Sequence[str], runs: int) -> tuple[str, dict[str, float | int]]:
    """Return a sentence on gaps and values of a finding, as parts of the intervals."""
    each = dict(zip(names, empty.each, strict=True))
    values = {f"gap of {name}": part for name, part in each.items()}
    values = {"gap": empty.all_together, **values, "gap in lengths of variation": empty.relative, "runs": runs}
    if len(names) == 1:
        interval = f"{_part(empty.each[0])} of the interval of {names[0]!r}"
        return f"{runs} runs cannot exclude a {FEATURE} narrower than {interval}.", values
    parts = ", ".join(f"{_part(part)} of {name!r}" for name, part in each.items())
    sentence = (
        f"{runs} runs cannot exclude a {FEATURE} narrower than {_part(empty.all_together)} of every interval, or in a "
        f"single parameter narrower than {parts}."
    )
    return sentence, values


def _part(share: float) -> str:
    return f"{float(f'{100 * share:.2g}'):g} %"
