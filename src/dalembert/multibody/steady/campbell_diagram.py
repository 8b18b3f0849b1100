"""Campbell diagrams of mechanisms."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from dalembert.arguments import is_number, takes_checked
from dalembert.errors import InputError, ModelError, shown
from dalembert.multibody.model.system import BaseSystem
from dalembert.multibody.steady.small_vibrations import Modes, modes
from dalembert.multibody.steady.steady_motion import FIXED
from dalembert.structure.campbell import Campbell, SpeedModes, followed

OnSpeed = Callable[[float, Modes], None]


@takes_checked()
def campbell(
    builder: Callable[[float], BaseSystem],
    speeds: Sequence[float] | np.ndarray,
    count: int | None = None,
    *,
    frame: str | None = None,
    parameter: str = "speed",
    unit: str = "rad/s",
    on_speed: OnSpeed | None = None,
) -> Campbell:
    """Modes of a mechanism over the speed at which it turns.

    Modes are computed about the steady rotation at each speed, as :func:`modes` does, in the same frame at all speeds.
    They are followed by their shapes and roots from the highest speed down.

    Parameters
    ----------
    builder : callable
        ``builder(speed)`` returns the mechanism; the angular velocities that its bodies or :meth:`System.pose` state
        depend on the speed.
    speeds : sequence of float
        Values of the argument.
    count : int, optional
        How many modes, from the lowest at the highest speed on; all if not given.
    frame : {"fixed", "rotating"}, optional
        Where frequencies are observed; that of the highest speed if not given.
    parameter, unit : str
        Name and unit of the argument, for tables and figures.
    on_speed : callable, optional
        Is called with each speed and its `Modes`.

    Returns
    -------
    Campbell

    Raises
    ------
    InputError
        For speeds that are not finite numbers.
    ModelError
        Where the rotation is not steady at a speed.

    Examples
    --------
    A top on springs: its modes whirl forward and backward, and their frequencies are apart by the gyroscopic torque.

    >>> from dalembert.multibody import campbell
    >>> from dalembert.multibody.spatial import Inertia, RigidBody, SpatialSystem, SphericalJoint, Spring
    >>> def top(speed):
    ...     system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    ...     inertia = Inertia(1.0, (1.0, 1.0, 1.6))
    ...     tip = {"tip": (0.0, 0.0, 1.0)}
    ...     disc = system.add(RigidBody("disc", inertia, points=tip, angular_velocity=(0.0, 0.0, speed)))
    ...     _ = system.add(SphericalJoint("ball", system.ground, disc.point("origin")))
    ...     for name, place in (("x", (2.0, 0.0, 1.0)), ("y", (0.0, 2.0, 1.0))):
    ...         side = system.ground.point(place)
    ...         _ = system.add(Spring(name, side, disc.point("tip"), stiffness=32000.0, free_length=2.0))
    ...     return system
    >>> diagram = campbell(top, [0.0, 200.0])
    >>> diagram.frequencies.round(2).tolist()
    [[28.47, 28.47], [12.73, 63.66]]
    >>> [diagram.direction(mode) for mode in range(2)]
    ['backward', 'forward']
    """
    given: list[Any] = list(speeds)
    if not given or not all(is_number(speed) and not np.iscomplexobj(speed) for speed in given):
        raise InputError(f"campbell: speeds is {shown(speeds)}; expected at least one finite number")
    order = sorted(range(len(given)), key=lambda row: -abs(given[row]))
    found: dict[int, Modes] = {}
    for row in order:
        try:
            system = builder(given[row])
            found[row] = modes(system, frame=frame if given[row] else None)
        except ModelError as error:
            raise ModelError(f"{parameter} = {given[row]:.6g} {unit}: {error}") from error
        if frame is None and found[row].speed:
            frame = found[row].frame
        if on_speed:
            on_speed(float(given[row]), found[row])
    kept = [found[row] for row in range(len(given))]
    at_speeds = [SpeedModes(each.speed, each.roots, each.shapes, each.whirl, each.growth) for each in kept]
    roots, whirl = followed(at_speeds, count)
    speed, growth = (np.array([getattr(each, name) for each in kept]) for name in ("speed", "growth"))
    return Campbell(parameter, unit, np.array(given, dtype=float), speed, roots, whirl, growth, frame or FIXED)
