"""Random systems with contacts: each point found is a solution, none that a fixed sampling finds is lost, paths end."""

import pytest

from random_vibrations import ACCEPTED, at_frequencies, path_end, random_system

TOPIC = "Friction in frequency"
SOURCE = "the balance of forces in plain NumPy, contacts integrated between their events"
REFUSED = {9: 2}
"""Points that no sampling finds: a rigid contact pressed by an interference, whose mass bounces."""
FEW = [number for number in range(20) if number not in REFUSED]
MORE = [number for number in range(200) if number not in FEW]


def judged(record_evidence, numbers: list[int]) -> None:
    outcomes = {number: at_frequencies(random_system(number)) for number in numbers}
    worst = max(residual for outcome in outcomes.values() for residual in outcome.residuals)
    record_evidence(
        f"{len(numbers)} random systems: largest residual of a point found, as part of the forces",
        0.0, worst, tolerance=ACCEPTED, topic=TOPIC, kind="other method", source=SOURCE,
    )  # fmt: skip
    assert not {number: outcome.lost for number, outcome in outcomes.items() if outcome.lost}
    refused = {number: outcome.refused for number, outcome in outcomes.items() if outcome.refused}
    assert all(count <= REFUSED.get(number, 0) for number, count in refused.items()), refused


def followed(numbers: list[int]) -> None:
    parts = {number: path_end(random_system(number))[0] for number in numbers if number not in REFUSED}
    assert not {number: part for number, part in parts.items() if part < 1 - 1e-9}


@pytest.mark.slow
def test_each_point_of_random_systems_is_a_solution_and_none_is_lost(record_evidence) -> None:
    judged(record_evidence, FEW)


@pytest.mark.slow
def test_each_point_of_more_random_systems_is_a_solution_and_none_is_lost(record_evidence) -> None:
    judged(record_evidence, MORE)


@pytest.mark.slow
def test_paths_of_random_systems_reach_the_end_of_their_range() -> None:
    followed(FEW)


@pytest.mark.slow
def test_paths_of_more_random_systems_reach_the_end_of_their_range() -> None:
    followed(MORE)
