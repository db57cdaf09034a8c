"""The encoders as the machine has reported them, and what was read of them.

Only the numbers that planning has asked for are kept: with them it can be repeated from the start and comes
out the same, which is how an operator's action takes effect in motion that was planned already.
"""

import bisect
from array import array
from collections import deque

import numpy as np
from numpy.typing import NDArray

from controller.motion.requests import Touch

Floats = NDArray[np.float64]


class Encoders:
    """Measured positions and the setpoints that go with them, tick by tick."""

    def __init__(self, axes: int, *, rows: int, rate: int) -> None:
        """`rows`: ticks between the first and the last position of a measured speed, and one; `rate`:
        ticks per second."""
        self._rate = rate
        self._actual = deque([np.zeros(axes)] * rows, maxlen=rows)
        self._setpoint = deque([np.zeros(axes)] * 2, maxlen=2)
        self._tick = 0
        self._read: dict[tuple[str, int], tuple[array[int], array[float]]] = {}
        self._touches: list[Touch] = []

    def take(self, tick: int, setpoint: Floats, actual: Floats) -> None:
        """The last rows up to `tick`: (n, axes) setpoints as the drives saw them, and measured positions."""
        self._setpoint.extend(np.array(setpoint[-2:]))
        self._actual.extend(np.array(actual[-len(self._actual) :]))
        self._tick = tick

    def rest(self, tick: int) -> None:
        """Nothing has moved up to `tick`."""
        for rows in (self._actual, self._setpoint):
            rows.extend([rows[-1]] * min(tick - self._tick, len(rows)))
        self._tick = tick

    def touched(self, latch: Floats) -> None:
        """The skip signal has come at the last tick; (axes,) measured positions there."""
        self._touches.append(Touch(self._tick / self._rate, tuple(latch.tolist())))

    def touch(self, begin: float, end: float) -> Touch | None:
        """The skip signal between two times [s], if it has come."""
        return next((touch for touch in self._touches if begin < touch.time <= end), None)

    def at(self, tick: int) -> "ReadingAt":
        """The encoders at the last tick, or at an earlier one at which they were read."""
        return ReadingAt(self, tick)

    def value(self, what: str, axis: int, tick: int) -> float:
        """One number, read now or kept from an earlier reading."""
        ticks, values = self._read.setdefault((what, axis), (array("q"), array("d")))
        k = bisect.bisect_left(ticks, tick)
        if k == len(ticks) or ticks[k] != tick:
            if tick != self._tick:
                raise LookupError(f"{what} of axis {axis} was not read at tick {tick}")
            ticks.insert(k, tick)
            values.insert(k, self._now(what, axis))
        return values[k]

    def _now(self, what: str, axis: int) -> float:
        actual, setpoint = self._actual, self._setpoint
        if what == "position":
            return float(actual[-1][axis])
        if what == "command":
            return float(setpoint[-1][axis])
        if what == "command speed":
            return float(setpoint[-1][axis] - setpoint[0][axis]) * self._rate
        return float(actual[-1][axis] - actual[0][axis]) / (len(actual) - 1) * self._rate


class ReadingAt:
    """The encoders at one tick: a Sensor."""

    def __init__(self, encoders: Encoders, tick: int) -> None:
        self._encoders, self._tick = encoders, tick

    def position(self, axis: int) -> float:
        """Measured position [mm | deg]."""
        return self._encoders.value("position", axis, self._tick)

    def command(self, axis: int) -> float:
        """The setpoint as the drive saw it last [mm | deg]."""
        return self._encoders.value("command", axis, self._tick)

    def command_speed(self, axis: int) -> float:
        """Speed of that setpoint over the last tick [mm/s | deg/s]."""
        return self._encoders.value("command speed", axis, self._tick)

    def speed(self, axis: int) -> float:
        """Measured speed over the last feed period [mm/s | deg/s]."""
        return self._encoders.value("speed", axis, self._tick)
