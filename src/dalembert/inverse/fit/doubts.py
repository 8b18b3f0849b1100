"""Why an answer that the search found is to be doubted, each reason in a few words."""

import re

import numpy as np

from dalembert.inverse.least_squares.estimate import Identifiability

EXCESSIVE = "what the given deviations allow"
"""Words of the sentence of a status that speaks against the answer."""


def doubts(status: str, told: Identifiability) -> tuple[str, ...]:
    """Reasons from the status, then parameters on a bound, untold or not told apart; each sentence without its advice.

    Examples
    --------
    >>> told = Identifiability(np.ones(1), np.eye(1), ("'k' sits on its upper bound 2; widen the bound.",))
    >>> doubts("Converged. The misfit is 9 times what the given deviations allow; look closer.", told)
    ('The misfit is 9 times what the given deviations allow', "'k' sits on its upper bound 2")
    """
    against = [sentence for sentence in re.split(r"(?<=\.) ", status) if EXCESSIVE in sentence]
    known = bool(np.all(np.isfinite(told.singular_values)))  # without sensitivities nothing is found wrong
    return tuple(re.split(r"[;:]\s|\s\(", sentence)[0] for sentence in (*against, *(told.sentences if known else ())))
