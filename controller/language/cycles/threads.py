"""G76: a thread in passes of equal chip section, fed in along one flank."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from controller.language.cycles.strokes import MOST_PASSES, Point, Stroke

ANGLES = (0, 29, 30, 55, 60, 80)
"""angles of the tool tip that P can name [deg]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Threading:
    """The numbers of a threading cycle. Lengths in slide travel [mm]."""

    start: Point
    """Z and X before the cycle"""
    end: Point
    """Z and X at the root of the thread's end"""
    taper: float
    """X of the thread's start minus X of its end"""
    height: float
    """of the thread, > 0"""
    first_depth: float
    """of the first pass, > 0"""
    smallest_depth: float
    """of any pass before the finishing ones, >= 0"""
    allowance: float
    """left for the finishing passes, 0 to `height`"""
    spring_passes: int
    """at full height, >= 1"""
    chamfer: float
    """run-out at the end [mm]"""
    tip_angle: float
    """[deg]"""
    lead: float
    """[mm per turn]"""
    start_angle: float
    """[deg]"""


def depths(data: Threading) -> list[float] | None:
    """Depth of every pass below the crest, the last ones equal; None for more than `MOST_PASSES`.

    Pass n stands at first depth · √n, so that each cuts the same section, but advances by the smallest depth
    at least.
    """
    rough = data.height - data.allowance
    passes: list[float] = []
    while not passes or passes[-1] < rough:
        before = passes[-1] if passes else 0.0
        step = max(data.first_depth * math.sqrt(len(passes) + 1) - before, data.smallest_depth)
        passes.append(min(before + step, rough) if rough > 0.0 else data.height)
        if len(passes) + data.spring_passes > MOST_PASSES:
            return None
    return passes + [data.height] * data.spring_passes


def cut_thread(data: Threading, passes: list[float]) -> Iterator[Stroke]:
    """All strokes, from the start point and back to it."""
    along = math.copysign(1.0, data.end[0] - data.start[0])
    inward = math.copysign(1.0, data.end[1] - data.start[1])
    crest = data.end[1] - inward * data.height
    flank = math.tan(math.radians(data.tip_angle / 2.0))
    for depth in passes:
        z, bottom = data.start[0] + along * depth * flank, crest + inward * depth
        yield Stroke(end=(z, data.start[1]), rapid=True)
        yield Stroke(end=(z, bottom + data.taper), rapid=True)
        yield from _cut(data, (z, bottom + data.taper), (data.end[0], bottom), inward)
        yield Stroke(end=(data.end[0], data.start[1]), rapid=True)
    yield Stroke(end=data.start, rapid=True)


def _cut(data: Threading, begin: Point, end: Point, inward: float) -> Iterator[Stroke]:
    """One pass; its last `chamfer` millimetres leave the thread at 45 degrees.

    A thread that follows a thread at once goes on with its helix.
    """
    way = end[0] - begin[0]
    run_out = min(data.chamfer, abs(way), abs(end[1] - data.start[1]))
    share = 1.0 - run_out / abs(way)
    turn = (begin[0] + way * share, begin[1] + (end[1] - begin[1]) * share)
    if share > 0.0:
        yield Stroke(end=turn, lead=data.lead, start_angle=data.start_angle)
    if run_out > 0.0:
        out = (end[0], turn[1] - inward * run_out)
        yield Stroke(end=out, lead=data.lead, start_angle=data.start_angle)
