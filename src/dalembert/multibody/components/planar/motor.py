"""Motors that a voltage or a current drives."""

__all__ = ["Motor"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.laws.motor_law import MotorNumbers
from dalembert.multibody.components.planar.motor_law import Drive, drive_kind
from dalembert.multibody.components.rows import Lowering


@inlined
def _command(x, v, p, m, inputs):
    return inputs.signals[m.command, 0]


MOTOR = drive_kind("motor", _command, integers=("command",))


@dataclass(frozen=True)
class Motor(MotorNumbers, Drive):
    """A direct-current motor with a gear between two bodies: it turns b against a.

    With the gear ratio N, the rate w of b against a, and the voltage U within its limit, the current is
    i = (U - back_emf N w)/resistance, and the torque on b is N torque_constant i, less the losses of the gear. The
    opposite torque acts on a.

    Parameters
    ----------
    name : str
    a, b : Point or ground
        Stator and output, which a revolute joint should connect.
    torque_constant : float
        N m/A.
    resistance : float
        Ohm; needed with a ``voltage``.
    back_emf : float
        Back-EMF constant, V s/rad; that of the torque if not given.
    voltage_limit : float, optional
        V. Larger voltages are reduced to it. The corners are rounded over 2 % of the limit, so that the torque has a
        derivative; the voltage differs by at most 0.7 % of the limit.
    gear_ratio : float
        Turns of the armature per turn of b against a; negative if they turn in opposite directions.
    efficiency : float
        Of the gear, in (0, 1]. The torque behind the gear is N k i e where the motor drives and N k i / e where it is
        driven, with the efficiency e; in between it is N k i e^s, s = tanh(w / slip_rate) sign(N i). So the friction
        of the gear grows with the motor's torque, and acts against the rate.
    slip_rate : float
        Rate of b against a, rad/s, over which the losses of the gear turn their sign.
    armature_inertia : float
        kg m^2, about the armature's axis. N^2 times it resists the angular acceleration of b against a. Where a turns
        as well, terms of the relative size 1/N are missing.
    enabled : float or Signal
        Factor of the current: 1, or 0 where the motor is switched off (no current, so no torque and no braking). A
        ``Step(1.0, 0.0, 2.0)`` switches off at 2 s.
    voltage : float or Signal, optional
        V. Give this or a ``current``.
    current : float or Signal, optional
        A. The amplifier then controls the current, and resistance and back-EMF have no influence.

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

    def lower(self, lowering: Lowering) -> None:
        number = self._command(lowering)
        pair = self._pair(lowering, f"motor {self.name!r}")
        numbers, integers = self._law(lowering, by_current=self.voltage is None)
        lowering.add(self.kind, pair.slots, [*pair.data, *numbers], [*pair.integers, *integers, number], self.name)
