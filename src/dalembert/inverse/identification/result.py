"""The fit that an identification returns."""

from collections.abc import Mapping
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from dalembert.findings import Finding
from dalembert.forward.provenance import provenance
from dalembert.inverse.experiments.experiments import JointModel
from dalembert.inverse.fit.fit import Fit
from dalembert.inverse.identification.assess import Optimum
from dalembert.inverse.noise.models.noise_catalogue import as_table
from dalembert.optimize import Minimiser
from dalembert.stored_fields import encoded

NO_SUCCESS = {"non-deterministic-model", "unconfirmed-minimum"}
"""Codes of findings with which a converged search is no success."""


def fit_of(optimum: Optimum, outcome: tuple[Finding, ...], findings: tuple[Finding, ...]) -> Fit:
    """Return the fit of an optimum and of what its checks yield."""
    posed, end, noise, at = optimum.posed, optimum.end, optimum.minimum.noise, optimum.linearisation
    whole, split, method, journal = posed.whole, posed.split, optimum.settings.method, optimum.problem.journal
    codes = {finding.code for finding in (*outcome, *findings)}
    return Fit(
        parameters=whole.model.parameters,
        values=optimum.vector,
        **vars(optimum.estimate),
        misfit=end.misfit,
        response=optimum.full_response,
        data=whole.data,
        weights=np.where(split.fitted, split.whole_table(optimum.problem.weights, 0.0), 0.0),
        history=tuple(journal.history),
        starts=tuple(journal.starts),
        success=end.success and not NO_SUCCESS & codes,
        outcome=outcome,
        method=method.name if isinstance(method, Minimiser) else type(method).__name__,
        simulations=journal.simulations,
        provenance=_provenance(optimum),
        parts=posed.parts,
        validation=optimum.validation,
        nodes=end.nodes,
        findings=findings,
        integration=optimum.integration,
        correlated=optimum.correlated,
        halves=optimum.causes.halves,
        jacobian=None if at is None or not optimum.minimum.is_one_run else split.whole_table(at.jacobian, np.nan),
        noise=None if noise is None else replace(noise.noise, whitened=split.whole_table(noise.noise.whitened, np.nan)),
    )


def _provenance(optimum: Optimum) -> Mapping[str, Any]:
    """Versions, model, data and settings, with those settings that are not the usual ones."""
    posed, chosen, whole, noise = optimum.posed, optimum.settings, optimum.posed.whole, optimum.minimum.noise
    unusual: dict[str, object] = {}
    if chosen.shooting is not None:
        unusual["shooting"] = asdict(chosen.shooting)
    if whole.loss is not None:
        unusual["loss"] = {"name": whole.loss.name, "scale": whole.loss.scale}
    if (validation := posed.validation) is not None:
        plain = isinstance(validation, float | int | str | Mapping)
        unusual["validation"] = encoded(validation if plain else list(validation))
    if noise is not None:
        unusual["noise"] = {channel: as_table(model) for channel, model in noise.noise.models.items()}
    if isinstance(whole.model, JointModel):
        unusual["experiments"] = [part.name for part in whole.model.parts]
    return provenance(
        whole.model,
        chosen.method,
        data=whole.data.fingerprint,
        units=dict(whole.data.source_units),
        seed=chosen.seed,
        starts=chosen.starts,
        start=None if chosen.start is None else whole.model.parameters.vector(chosen.start).tolist(),
        weights=posed.weights_source,
        polish=chosen.polish,
        horizon=chosen.horizon,
        spread=chosen.spread,
        **unusual,
    )
