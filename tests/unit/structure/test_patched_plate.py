import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.structure import Patch, Structure, foot_pairs, patched_plate
from support import says


@pytest.fixture(scope="module")
def whole() -> Structure:
    return patched_plate(elements=2)


def test_an_arch_starts_and_ends_flat_on_the_plate() -> None:
    patch = Patch()
    np.testing.assert_allclose(patch.rise(patch.stations), 0, atol=1e-18)
    middles = (patch.stations[1:] + patch.stations[:-1]) / 2
    np.testing.assert_allclose(patch.rise(middles), [0, patch.height, 0, patch.height, 0], atol=1e-18)
    assert patch.length == pytest.approx(patch.stations[-1] - patch.clearance)


def test_feet_lie_on_nodes_of_the_plate_that_are_not_joined(whole: Structure) -> None:
    assert whole.nodes is not None
    few, every = foot_pairs(whole), foot_pairs(whole, every=True)
    assert (len(few), len(every)) == (4 * 8, 13 * 8)
    assert set(few) < set(every)
    feet, below = (whole.nodes.places[whole.nodes.rows(side)] for side in zip(*few, strict=True))
    np.testing.assert_allclose(feet, below, atol=1e-12)
    np.testing.assert_allclose(feet[:, 2], 2e-3)
    assert all(whole.dofs.has_node(node) for pair in every for node in pair)
    # Two at each end of the outer foot of the patch at x = 0.
    np.testing.assert_allclose(np.sort(feet[:4, 0]), [3e-3, 3e-3, 7e-3, 7e-3])
    np.testing.assert_allclose(np.sort(feet[:4, 1] - 0.2025), [-2.25e-3, -2.25e-3, 2.25e-3, 2.25e-3])


def test_the_four_patches_are_turned_copies(whole: Structure) -> None:
    assert whole.nodes is not None
    names = [[node for node in whole.nodes.names if node.startswith(f"patch {number}/")] for number in range(1, 5)]
    first, second, third, fourth = (whole.nodes.places[whole.nodes.rows(own)] for own in names)
    centre = np.array([0.2025, 0.2025])
    np.testing.assert_allclose(third[:, :2] - centre, centre - first[:, :2], atol=1e-15)
    np.testing.assert_allclose(fourth[:, :2] - centre, centre - second[:, :2], atol=1e-15)
    np.testing.assert_allclose(second[:, 0] - 0.2025, 0.2025 - first[:, 1], atol=1e-15)


def test_middles_are_joined_to_the_plate(whole: Structure) -> None:
    assert whole.nodes is not None
    assert all(node.startswith("plate/") for node in whole.nodes.members("patch 3/middle"))
    assert not any(node.startswith("plate/") for node in whole.nodes.members("patch 3/inner foot"))


def test_patches_that_meet_are_refused() -> None:
    sentence = (
        "patched_plate: patches of width 0.009 m that reach 0.067 m inwards meet on a plate of 0.1 m; make them smaller"
    )
    with pytest.raises(InputError, match=says(sentence)):
        patched_plate(side=0.1)
