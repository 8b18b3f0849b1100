"""A number as a person types it: with a decimal comma or point, with a unit or in that of its field."""

from dalembert.errors import InputError
from dalembert.units import is_quantity, si

_MINUS = "\N{MINUS SIGN}"


def typed_number(text: str | None, unit: str = "", size: float = 1.0) -> float:
    """Return the number of a text in SI units.

    Parameters
    ----------
    text : str, optional
    unit : str
        Of the field, for a text without one.
    size : float
        Of that unit in SI units.

    Raises
    ------
    InputError
        If the text is not a number, or has the unit of another quantity.

    Examples
    --------
    >>> typed_number("-2,5", "mm", 1e-3), typed_number("400 mN/m", "N/m"), typed_number("3")
    (-0.0025, 0.4, 3.0)
    >>> typed_number("1,234.5")
    Traceback (most recent call last):
    dalembert.errors.InputError: Enter a number with one decimal point or comma, and no other separators
    """
    written = (text or "").strip().replace(_MINUS, "-")
    if written.count(",") + written.count(".") > 1:
        raise InputError("Enter a number with one decimal point or comma, and no other separators")
    written = written.replace(",", ".")
    try:
        return si(written, unit or None) * size if is_quantity(written) else si(written, "") * size
    except InputError:
        example = f"2.5, or 2.5 {unit} with its unit" if unit else "2.5"
        raise InputError(f"{text!r} is not a number in this unit. Enter a number such as {example}") from None
