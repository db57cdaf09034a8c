"""Play between motor side and load side: a dead zone in which the guides hold the load.

The load stays where its friction holds it until the motor has crossed the play and takes it along: the
hysteresis of a load whose friction outweighs its inertia inside the play, which is micrometres wide. A load
that outweighs the friction lies against the flank it is pushed to. The motor feels the load's mass all the
time: what it misses while it crosses is J a over micrometres, far below what its encoder resolves.
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class Backlash:
    """One axis's load side, from power-on in the middle of its play."""

    def __init__(self, width: float, friction: float) -> None:
        """`width` of the whole play [m | rad]; `friction` of the load's guides [N | N m]."""
        self._half = 0.5 * width
        self._friction = friction
        self._load = 0.0

    def follow(self, motor: Floats, force: Floats | None = None) -> Floats:
        """(n,) load positions behind (n,) motor positions; (n,) `force` pushes the load itself."""
        half, load, friction = self._half, self._load, self._friction
        if not half:
            return motor
        pushes = [0.0] * len(motor) if force is None else force.tolist()
        positions: list[float] = []
        for q, push in zip(motor.tolist(), pushes, strict=True):
            if push > friction:
                load = q + half
            elif push < -friction:
                load = q - half
            else:
                load = min(max(load, q - half), q + half)
            positions.append(load)
        self._load = load
        return np.array(positions)
