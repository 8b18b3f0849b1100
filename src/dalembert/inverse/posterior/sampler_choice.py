"""Which sampler draws: the requested one, else one by what the model can compute."""

from dataclasses import dataclass, replace

import numpy as np

from dalembert.errors import DalembertError, InputError, StorageError, require_known, shown
from dalembert.forward import check_derivatives
from dalembert.inverse.noise.likelihood.likelihood import Likelihood
from dalembert.inverse.posterior.samplers.affine_invariant import AffineInvariant
from dalembert.inverse.posterior.samplers.delayed_acceptance import DelayedAcceptance
from dalembert.inverse.posterior.samplers.nuts import NUTS
from dalembert.inverse.posterior.samplers.sampler import Sampler
from dalembert.kinds import named
from dalembert.surrogate.scheme import Scheme


@dataclass(frozen=True)
class SamplerChoice:
    """A sampler, and whether the model has a jacobian where the search starts."""

    sampler: Sampler
    differentiable: bool


def requested_sampler(sampler: Sampler | str | None, surrogate: Scheme | bool | None) -> Sampler | None:
    """Return the sampler by the arguments of :func:`sample`, if it can run here; None if the model decides."""
    if isinstance(sampler, str):
        known = named("dalembert.inverse.posterior.samplers", Sampler)
        require_known("sampler", sampler, known)
        sampler = known[sampler]()
    if sampler is not None and not isinstance(sampler, Sampler):
        raise InputError(f"sample: sampler is {shown(sampler)}; expected a sampler such as NUTS(), or its name")
    if surrogate is not None and surrogate is not False:
        if sampler is not None and not isinstance(sampler, DelayedAcceptance):
            raise InputError(
                f"sample: surrogate and the sampler {sampler.name!r} were given; a surrogate proposes draws of the "
                "sampler 'delayed-acceptance'. Leave one of them out"
            )
        if surrogate is not True and not isinstance(surrogate, Scheme):
            raise InputError(
                f"sample: surrogate is {shown(surrogate)}; expected a scheme such as TotalDegree(4), or True"
            )
        sampler = sampler or DelayedAcceptance()
        sampler = sampler if surrogate is True else replace(sampler, scheme=surrogate)
    if sampler is not None:
        sampler.check()
    return sampler


def choose_sampler(requested: Sampler | None, likelihood: Likelihood, vector: np.ndarray) -> SamplerChoice:
    """Return the sampler for a likelihood whose search starts at a vector (parameters,)."""
    differentiable = _has_jacobian(likelihood, vector)
    sampler = requested or (NUTS() if differentiable else AffineInvariant())
    sampler.check()
    if sampler.gradients:
        model = likelihood.problem.model
        check_derivatives(model, vector[: len(model.parameters)])
        if not differentiable:
            raise InputError(
                f"sample: the sampler {sampler.name!r} needs a jacobian, which the model does not return; use the "
                "sampler 'affine-invariant'"
            )
    return SamplerChoice(sampler, differentiable)


def _has_jacobian(likelihood: Likelihood, vector: np.ndarray) -> bool:
    """Return whether the model returns a jacobian at a vector of the likelihood (parameters,)."""
    model = likelihood.problem.model
    try:
        model.linearise(vector[: len(model.parameters)])
    except StorageError:
        raise
    except (InputError, NotImplementedError, AttributeError):
        return False
    except DalembertError:
        return True  # it fails here, and may not elsewhere
    return True
