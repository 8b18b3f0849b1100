"""Findings on joints whose constraints follow from those of others."""

from dalembert.findings import Finding
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.start.assemble import inner_constraints, redundancy


def redundant_constraints(lowered: Lowered) -> tuple[Finding, ...]:
    """Return a finding on joints whose constraints follow from those of others at the start; none if all are needed."""
    count, rank, joints = redundancy(lowered)
    if not joints:
        return ()
    inside = inner_constraints(lowered)
    names = ", ".join(map(repr, joints))
    return (
        Finding(
            "redundant-constraints",
            "note",
            {"constraints": count - inside, "independent": rank - inside, "joints": names},
            f"The joints have {count - inside} constraints, {rank - inside} of them independent at the start. Those of "
            f"{names} follow from the others. Of all possible joint forces, the result has the smallest ones.",
            "If you need the joint forces, replace a joint by one that holds less, or a bushing.",
        ),
    )
