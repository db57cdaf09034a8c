"""G71 and G72, type I: stock removed in passes along one axis down to a profile that goes one way in both.

Coordinates are (feed axis, depth axis): (Z, X) for G71, (X, Z) for G72.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from controller.language.cycles.profile import NOTHING, Piece
from controller.language.cycles.strokes import Point, Stroke


@dataclass(frozen=True, slots=True, kw_only=True)
class Roughing:
    """The numbers of a roughing cycle."""

    depth: float
    """of one pass, > 0 [mm]"""
    escape: float
    """between the cut and the way back, along both axes, >= 0 [mm]"""
    allowance: Point
    """left for finishing, signed (feed axis, depth axis) [mm]"""


def monotonous(pieces: Sequence[Piece]) -> int | None:
    """Line of the first piece behind the first one that turns back in either axis; None where none does."""
    contour = pieces[1:]
    if not contour:
        return None
    into = pieces[0].end[1] - pieces[0].start[1]
    along = contour[-1].end[0] - contour[0].start[0]
    for piece in contour:
        forward = (piece.end[0] - piece.start[0]) * along
        outward = -(piece.end[1] - piece.start[1]) * into
        if piece.turns_back or forward < -NOTHING or outward < -NOTHING:
            return piece.line
    return None


def passes_needed(pieces: Sequence[Piece], data: Roughing) -> int:
    """How many passes the removal takes, without the last one along the profile."""
    return max(0, math.ceil(_total(pieces) / data.depth - 1e-9) - 1)


def remove(pieces: Sequence[Piece], data: Roughing) -> Iterator[Stroke]:
    """All strokes, from the start point and back to it.

    `pieces` is the profile from the start point on, the first one the infeed to it along the depth axis.
    A pass goes in as the infeed does, cuts to the profile with its allowance, leaves it at 45 degrees by
    the escape and comes back at rapid; the last pass follows the profile with its allowance.
    """
    start = pieces[0].start
    into = math.copysign(1.0, pieces[0].end[1] - start[1])
    contour = [piece.shifted(data.allowance) for piece in pieces[1:]]
    along = math.copysign(1.0, pieces[-1].end[0] - pieces[0].end[0])
    begin = (start[0] + data.allowance[0], start[1] + data.allowance[1])
    approach = pieces[0].rapid
    yield Stroke(end=begin, rapid=True, line=pieces[0].line)
    for n in range(passes_needed(pieces, data)):
        level = begin[1] + into * data.depth * (n + 1)
        piece = _limit(contour, level, into)
        reach = piece.first_at(level) if into * (piece.end[1] - level) <= 0.0 else piece.end[0]
        yield Stroke(end=(begin[0], level), rapid=approach, line=piece.line)
        yield Stroke(end=(reach, level), line=piece.line)
        clear = level - into * data.escape
        yield Stroke(end=(reach - along * data.escape, clear), rapid=True, line=piece.line)
        yield Stroke(end=(begin[0], clear), rapid=True, line=piece.line)
    infeed = pieces[0].shifted(data.allowance)
    yield Stroke(end=infeed.end, rapid=approach, line=infeed.line)
    for piece in contour:
        yield piece.stroke
    outside = into * min(into * start[1], into * contour[-1].end[1])
    last = contour[-1]
    yield Stroke(end=(last.end[0], outside), rapid=True, line=last.line)
    yield Stroke(end=(start[0], outside), rapid=True, line=last.line)
    yield Stroke(end=start, rapid=True, line=last.line)


def _limit(contour: Sequence[Piece], level: float, into: float) -> Piece:
    """The piece at which a pass on this level meets the profile; the last one where it meets none."""
    for piece in contour:
        if into * (piece.end[1] - level) <= NOTHING:
            return piece
    return contour[-1]


def _total(pieces: Sequence[Piece]) -> float:
    return abs(pieces[0].end[1] - pieces[0].start[1])
