"""G73: the profile cut several times, each time nearer, for castings and forgings."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from controller.language.cycles.profile import Piece
from controller.language.cycles.strokes import Point, Stroke


@dataclass(frozen=True, slots=True, kw_only=True)
class Pattern:
    """The numbers of a pattern cycle."""

    relief: Point
    """from the last to the first pass, Z and X [mm]"""
    divisions: int
    """number of passes, >= 1"""
    allowance: Point
    """left for finishing, Z and X [mm]"""


def repeat(pieces: Sequence[Piece], data: Pattern) -> Iterator[Stroke]:
    """All strokes, from the start point and back to it."""
    start = pieces[0].start
    for n in range(data.divisions):
        left = (data.divisions - 1 - n) / (data.divisions - 1) if data.divisions > 1 else 0.0
        by = (data.allowance[0] + left * data.relief[0], data.allowance[1] + left * data.relief[1])
        yield Stroke(end=(start[0] + by[0], start[1] + by[1]), rapid=True, line=pieces[0].line)
        for piece in pieces:
            yield piece.shifted(by).stroke
    yield Stroke(end=start, rapid=True, line=pieces[-1].line)
