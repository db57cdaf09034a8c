"""One straight path: how far, how fast, where a stroke limit cuts it off; and how far axes have been."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from controller.limits import Crossing
from controller.machine_data import MachineData

Floats = NDArray[np.float64]
NOTHING = 1e-9
"""[mm | deg] far below the least increment: rounding, not travel"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Path:
    """A straight path in all axes at once. Path length is Cartesian [mm]; of rotary axes alone in degrees."""

    own: Floats
    """(axes,) positions of the tracks at the start"""
    slides: Floats
    """(axes,) travel of the slides"""
    moving: tuple[int, ...]
    """columns of the slides that travel"""
    cartesian: Floats
    """(axes,) travel in program terms"""
    length: float
    top_speed: float
    """[1/s] the highest path speed that no axis exceeds"""
    acceleration: float
    """[1/s²]"""
    end: float
    """path position where the motion stops: `length` unless a stroke limit is in the way"""
    crossing: Crossing | None = None
    absolute: Mapping[int, float] = field(default_factory=dict)
    """absolute positions at `length`, exactly"""

    @property
    def fraction(self) -> float:
        """The part of the path that is travelled."""
        return self.end / self.length if self.length else 1.0


def path_limits(
    machine: MachineData, slides: Floats, induced: tuple[int, float] | None, *, rapid: bool
) -> tuple[float, float]:
    """Speed and acceleration [per unit of fraction] at which the first axis meets its limit.

    `induced` is a slave and its shift [deg] on the way: it shall not be driven beyond its limits either.
    """
    travels = [(k, abs(float(slides[k]))) for k in np.flatnonzero(slides)]
    speeds = [(machine.axes[k].rapid if rapid else machine.axes[k].cutting) / d for k, d in travels]
    rates = [machine.axes[k].acceleration / d for k, d in travels]
    if induced and induced[1] != 0.0:
        axis = machine.axes[induced[0]]
        speeds.append(axis.rapid / abs(induced[1]))
        rates.append(axis.acceleration / abs(induced[1]))
    return min(speeds, default=math.inf), min(rates, default=math.inf)


def stopping_point(length: float, limit: float, speed: float, acceleration: float, *, before: bool) -> float:
    """Where the path ends that meets a stroke limit at `limit` (parameter 1300#7, BFA).

    `before`: the axis stops on the limit; else it begins to brake there.
    """
    if before:
        return limit
    squared = min(speed * speed, 2.0 * acceleration * limit, 2.0 * acceleration * (length - limit))
    return min(length, limit + max(squared, 0.0) / (2.0 * acceleration))


@dataclass(slots=True)
class Extents:
    """The smallest and the largest position each axis has had."""

    low: Floats
    high: Floats

    @classmethod
    def at(cls, position: Floats) -> "Extents":
        """A single position (axes,)."""
        return cls(low=position.copy(), high=position.copy())

    def start(self, position: Floats) -> None:
        """Begin anew at a position (axes,)."""
        self.low[:] = self.high[:] = position

    def include(self, position: Floats) -> None:
        """Another position (axes,)."""
        np.minimum(self.low, position, out=self.low)
        np.maximum(self.high, position, out=self.high)
