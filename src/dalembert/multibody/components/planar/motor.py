"""Motors that a voltage or a current drives."""

__all__ = ["Motor"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import parameters_of
from dalembert.multibody.components.laws.motor_law import MotorNumbers
from dalembert.multibody.components.planar.drive import Drive, drive_kind


@inlined
def _command(x, v, p, m, inputs):
    return inputs.signals[m.command, 0]


MOTOR = drive_kind("motor", _command, integers=("command",))


@parameters_of(MotorNumbers)
@dataclass(frozen=True)
class Motor(Drive, MotorNumbers):
    """A direct-current motor with a gear between two bodies: it turns b against a.

    With the gear ratio N, the rate w of b against a, and the voltage U within its limit, the current is
    i = (U - back_emf N w)/resistance, and the torque on b is N torque_constant i, less the losses of the gear. The
    opposite torque acts on a.

    Parameters
    ----------
    name : str
    a, b : Point or ground
        Stator and output, which a revolute joint should connect.
    {law}

    Raises
    ------
    InputError
        With both or neither of ``voltage`` and ``current``, a voltage without ``resistance``, and numbers out of range.

    Notes
    -----
    Outputs: ``angle`` and ``rate`` of b against a, ``torque`` on b (without that of the armature's inertia),
    ``current``, and ``voltage`` at the terminals, resistance i + back_emf N w. The inductance is neglected: the current
    follows the voltage at once, which holds where the motion is slow compared to inductance/resistance.

    Examples
    --------
    The steady rate of a motor without load is voltage / back_emf:

    >>> from dalembert.multibody import RevoluteJoint, RigidBody, System, simulate
    >>> system = System(gravity=(0.0, 0.0))
    >>> disc = system.add(RigidBody("disc", mass=1.0, inertia=1e-3))
    >>> _ = system.add(RevoluteJoint("bearing", system.ground, disc.centre))
    >>> _ = system.add(Motor("motor", system.ground, disc.centre, torque_constant=0.05, resistance=1.0, voltage=6.0))
    >>> simulate(system, end=8.0).channels(["motor.rate"])[-1].round(3)
    array([120.])
    """

    kind = MOTOR
