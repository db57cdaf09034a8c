"""Strokes: the single motions a cycle consists of, in the Z X plane, and the commands they become."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from controller.commands import Arc, Command, Feed, Move, Thread

Point = tuple[float, float]
"""Z and X in work coordinates, slide travel [mm]"""
MOST_PASSES = 10_000
"""passes of one cycle; more are HT9016"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Stroke:
    """One motion to `end`: at rapid, at feed straight or on an arc, or as a thread."""

    end: Point
    rapid: bool = False
    centre: Point | None = None
    """of an arc"""
    clockwise: bool = False
    """of an arc"""
    lead: float = 0.0
    """of a thread [mm per turn]; 0 = no thread"""
    start_angle: float = 0.0
    """of a thread [deg]"""
    line: int | None = None
    """index of the line of the profile it comes from; None = the cycle's own block"""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlaneAxes:
    """Which axes the cycle moves, and where in the cycle's block they are named."""

    z: int
    """column"""
    x: int
    places: dict[int, int]
    """column -> text column of the word in the cycle's block"""


def commands_of(
    strokes: Iterable[Stroke], start: Point, axes: PlaneAxes, feed: Feed | None
) -> Iterator[tuple[int | None, Command]]:
    """The commands of strokes from `start` on, each with the line of the profile it comes from."""
    at = start
    for stroke in strokes:
        yield stroke.line, _command(stroke, at, axes, feed)
        at = stroke.end


def _command(stroke: Stroke, at: Point, axes: PlaneAxes, feed: Feed | None) -> Command:
    target = {axes.x: stroke.end[1], axes.z: stroke.end[0]}
    places = axes.places if stroke.line is None else {}
    if stroke.lead:
        return Thread(
            absolute=target, incremental={}, lead=stroke.lead, start_angle=stroke.start_angle, places=places
        )
    if stroke.centre is not None and feed is not None:
        return Arc(
            absolute=target,
            incremental={},
            plane=(axes.z, axes.x),
            centre=(stroke.centre[0] - at[0], stroke.centre[1] - at[1]),
            clockwise=stroke.clockwise,
            feed=feed,
            places=places,
        )
    return Move(absolute=target, incremental={}, feed=None if stroke.rapid else feed, places=places)
