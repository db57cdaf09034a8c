"""G74 and G75: pecking along one axis, repeated side by side along the other.

Coordinates are (peck axis, shift axis): (Z, X) for G74, (X, Z) for G75.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from controller.language.cycles.strokes import Point, Stroke

_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class Grooving:
    """The numbers of a pecking cycle."""

    start: Point
    end: Point
    peck: float
    """depth of one peck, > 0 [mm]"""
    shift: float
    """between two grooves, > 0 where start and end differ along the shift axis [mm]"""
    retract: float
    """after each peck, >= 0 [mm]"""
    relief: float
    """at the bottom, against the shift; signed where there is no shift [mm]"""


def grooves_needed(data: Grooving) -> int:
    """How many grooves side by side."""
    way = abs(data.end[1] - data.start[1])
    return 1 + (math.ceil(way / data.shift - _ROUNDING) if way > _ROUNDING else 0)


def pecks_needed(data: Grooving) -> int:
    """How many pecks a groove takes."""
    return max(1, math.ceil(abs(data.end[0] - data.start[0]) / data.peck - _ROUNDING))


def peck(data: Grooving) -> Iterator[Stroke]:
    """All strokes, from the start point and back to it."""
    into = math.copysign(1.0, data.end[0] - data.start[0])
    way = data.end[1] - data.start[1]
    aside = math.copysign(1.0, way)
    relief = -aside * data.relief if way else data.relief
    grooves, pecks = grooves_needed(data), pecks_needed(data)
    for n in range(grooves):
        side = data.end[1] if n and n == grooves - 1 else data.start[1] + aside * data.shift * n
        if n:
            yield Stroke(end=(data.start[0], side), rapid=True)
        for k in range(1, pecks):
            depth = data.start[0] + into * data.peck * k
            yield Stroke(end=(depth, side))
            yield Stroke(end=(depth - into * data.retract, side), rapid=True)
        yield Stroke(end=(data.end[0], side))
        bottom = side + relief
        if relief:
            yield Stroke(end=(data.end[0], bottom), rapid=True)
        yield Stroke(end=(data.start[0], bottom), rapid=True)
    yield Stroke(end=data.start, rapid=True)
