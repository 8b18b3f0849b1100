"""Static contact: results, findings, errors."""

import numpy as np
import pytest

from dalembert.errors import InputError, SolveError
from dalembert.structure import Dofs, Structure, lumped
from dalembert.vibration import (
    CubicSpring,
    ElasticSlider,
    FrictionContact,
    HarmonicForce,
    Iwan,
    Rigid,
    StaticContact,
    StaticForce,
    VibrationSystem,
    static_contact,
)
from lap_joint import bars, lap_joint
from support import says


def block(push: float = 40.0, press: float = 50.0, law: ElasticSlider | Iwan | Rigid | None = None, **more: float):
    """A block on a foot: 1e3 N/m to the ground along the foot."""
    system = VibrationSystem(Structure(np.eye(2), np.diag([1e3, 0.0]), Dofs(("m.x", "m.z"))))
    system.add(StaticForce("m.x", push))
    system.add(StaticForce("m.z", press))
    law = law or ElasticSlider(1e4, normal_stiffness=1e6)
    system.add(FrictionContact("foot", "m", normal="z", friction=0.5, law=law, **more))
    return system


@pytest.mark.parametrize(
    ("push", "state", "friction", "moved"),
    [(11.0, 1, 10.0, 1e-3), (40.0, 2, 25.0, 15e-3)],
    ids=["sticks", "slips"],
)
def test_a_foot_sticks_below_the_limit_and_slips_above(push: float, state: int, friction: float, moved: float):
    joint = static_contact(block(push))
    assert joint.states.tolist() == [state]
    np.testing.assert_allclose(joint.normal, [50.0])
    np.testing.assert_allclose(joint.tangential[0, 0], friction)
    assert np.isnan(joint.tangential[0, 1])
    np.testing.assert_allclose(joint.displacement("m.x"), moved)
    np.testing.assert_allclose(joint.openings, [-50e-6])
    assert joint.residual < 1e-12
    assert joint.success


def test_cells_of_an_iwan_contact_yield_one_after_the_other():
    joint = static_contact(block(20.0, law=Iwan((5e3, 5e3), (0.2, 0.8), 1e6)))
    # The first cell is at its limit of 5 N, the second one sticks: 1e3 x + 5 + 5e3 x = 20.
    np.testing.assert_allclose(joint.displacement("m.x"), 15 / 6e3)
    np.testing.assert_allclose(joint.friction, [5 + 5e3 * 15 / 6e3])
    np.testing.assert_allclose(joint.normal, [50.0])
    assert joint.states.tolist() == [2]


def test_an_interference_presses_without_a_force():
    system = VibrationSystem(lumped({"m.z": 1.0, "m.x": 1.0}, [("m.z", None, 1e6, 0.0), ("m.x", None, 1e3, 0.0)]))
    law = ElasticSlider(1e4, normal_stiffness=1e6, gap=-2e-5)
    system.add(FrictionContact("fit", "m", normal="z", friction=0.5, law=law))
    joint = static_contact(system)
    np.testing.assert_allclose(joint.normal, [10.0])  # two equal springs in series share 20 μm
    np.testing.assert_allclose(joint.displacement("m.z"), -1e-5)


def test_springs_that_are_not_linear_take_part():
    system = block(40.0)
    system.add(CubicSpring("cubic", "m.x", stiffness=1e6))
    joint = static_contact(system)
    moved = joint.displacement("m.x")
    np.testing.assert_allclose(1e3 * moved + 1e6 * moved**3 + joint.friction[0], 40.0)


def test_harmonic_forces_do_not_act():
    system = block(11.0)
    system.add(HarmonicForce("m.x", 1e3))
    np.testing.assert_array_equal(static_contact(system).displacements, static_contact(block(11.0)).displacements)


def test_a_joint_that_nothing_closes_is_a_finding():
    system = VibrationSystem(lumped({"m.z": 1.0, "m.x": 1.0}, [("m.z", None, 1e6, 0.0), ("m.x", None, 1e3, 0.0)]))
    system.add(StaticForce("m.z", -30.0))
    law = ElasticSlider(1e4, normal_stiffness=1e6)
    system.add(FrictionContact("fit", "m", normal="z", friction=0.5, law=law))
    joint = static_contact(system)
    assert [finding.code for finding in joint.findings] == ["open-joint"]
    assert "at least 3 × 10⁻⁵ m wide" in joint.findings[0].message
    assert not joint.success
    assert joint.states.tolist() == [0]
    np.testing.assert_allclose(joint.normal, [0.0], atol=1e-12)


def test_a_push_that_friction_does_not_hold_is_said():
    system = VibrationSystem(Structure(np.eye(2), np.zeros((2, 2)), Dofs(("m.x", "m.z"))))
    system.add(StaticForce("m.x", 40.0))
    system.add(StaticForce("m.z", 50.0))
    law = ElasticSlider(1e4, normal_stiffness=1e6)
    system.add(FrictionContact("foot", "m", normal="z", friction=0.5, law=law))
    with pytest.raises(SolveError, match="Friction may not hold them"):
        static_contact(system)


def test_rigid_contacts_and_none_are_refused():
    rigid = (
        "static_contact: the contact 'foot' is rigid; expected elastic ones. Give it an ElasticSlider with the "
        "stiffness of the surfaces"
    )
    with pytest.raises(InputError, match=says(rigid)):
        static_contact(block(law=Rigid(penalty=1e6)))
    none = "static_contact: the system has no friction contact; add one (FrictionContact)"
    with pytest.raises(InputError, match=says(none)):
        static_contact(VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.0)])))
    with pytest.raises(InputError, match=says("StaticContact: 'm.y' is not a degree of freedom of the structure")):
        static_contact(block()).displacement("m.y")


@pytest.fixture(scope="module")
def joint() -> StaticContact:
    mesh, between = bars(4, 2)
    return static_contact(lap_joint(mesh, mesh, between, force=4.0, bolt=1000.0))


def test_it_is_kept_whole(joint: StaticContact, tmp_path):
    joint.save(tmp_path / "joint.nc")
    again = StaticContact.load(tmp_path / "joint.nc")
    np.testing.assert_array_equal(again.normal, joint.normal)
    np.testing.assert_array_equal(again.contact_places, joint.contact_places)
    assert again.summary() == joint.summary()
    assert again.contacts == joint.contacts


def test_its_report_shows_the_interface(joint: StaticContact, tmp_path):
    page = joint.report(tmp_path / "joint.html").read_text()
    assert "Normal forces over the interface" in page
    assert "The 20 contacts with the largest normal forces" in page
    bare = static_contact(block()).report(tmp_path / "bare.html").read_text()
    assert "Normal forces over the interface" not in bare
    assert "foot" in bare
