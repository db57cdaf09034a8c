"""The displays: absolute and relative coordinates, and the Cartesian machine position.

Machine (slide) coordinates are no register but the axes themselves. Inside everything is slide travel:
lengths in radius, rotary axes unwrapped; modulo and diameter belong to the surface (rulings, sections 2-4).
"""

from collections.abc import Mapping
from dataclasses import dataclass

TURN = 360.0
"""[deg]"""


def modulo(angle: float) -> float:
    """An angle as a rotary axis of type A displays it, 0 <= value < 360 [deg]."""
    wrapped = angle % TURN
    return 0.0 if wrapped >= TURN else wrapped


def shortest(delta: float) -> float:
    """The same rotation the short way: -180 < value <= 180 [deg]."""
    return TURN / 2.0 - (TURN / 2.0 - delta) % TURN


@dataclass(slots=True)
class Registers:
    """Commanded positions at the end of the last planned motion; each list has one entry an axis."""

    absolute: list[float]
    """work coordinates; sync motion enters only when the gear box is released"""
    relative: list[float]
    cartesian: list[float]
    """Cartesian machine position; equal to the slides but for an inclined pair"""
    zero: list[float]
    """absolute minus Cartesian machine position, as offsets and G50 have set it"""

    @classmethod
    def at_power_on(cls, axes: int) -> "Registers":
        """All zero: the machine stands on its reference points."""
        return cls([0.0] * axes, [0.0] * axes, [0.0] * axes, [0.0] * axes)

    def move(self, travel: Mapping[int, float], machine: Mapping[int, float]) -> None:
        """An ordinary motion: `travel` for the displays, `machine` for the Cartesian machine position; they
        differ under machine lock."""
        absolute, relative, cartesian = self.absolute, self.relative, self.cartesian
        for axis, amount in travel.items():
            absolute[axis] += amount
            relative[axis] += amount
        for axis, amount in machine.items():
            cartesian[axis] += amount

    def shift(self, axis: int, amount: float) -> None:
        """The work coordinate of the same place grows by `amount`."""
        self.absolute[axis] += amount
        self.zero[axis] += amount

    def orient(self, axis: int, machine: float) -> None:
        """A rotary axis that has turned freely stands at a known machine position again."""
        self.cartesian[axis] = machine
        self.absolute[axis] = modulo(machine + self.zero[axis])

    def compensate(self, axis: int, angle: float) -> None:
        """Helical compensation enters absolute and relative (hobbing, 斜齿轮加工)."""
        self.absolute[axis] += angle
        self.relative[axis] += angle

    def release(self, axis: int, angle: float) -> None:
        """At G80, G50.2 the absolute takes the sync motion, modulo 360° (polygon, 解除同步)."""
        self.absolute[axis] = modulo(self.absolute[axis] + angle)
