"""The finished profile of G70 to G73: what the blocks from P to Q say, as a chain of lines and arcs."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from controller.commands import Arc, Move
from controller.language.cycles.strokes import Point, Stroke
from controller.language.draft import Draft
from controller.language.families.arc_blocks import arc
from controller.language.families.straight_blocks import G00, G01, straight
from controller.language.syntax import Block
from controller.tables.alarms import alarm
from controller.tables.codes import Group, g_name

MOST_BLOCKS = 10_000
_G02, _G03 = 20, 30
_CODES = frozenset((G00, G01, _G02, _G03))
_WORDS = frozenset("XZUWRIKFS")
NOTHING = 1e-9
"""[mm] far below the least increment"""
_QUADRANT = math.pi / 2.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Piece:
    """A line or an arc of a profile, from `start` to `end`."""

    start: Point
    end: Point
    rapid: bool
    centre: Point | None
    clockwise: bool
    line: int
    """index of its block"""

    def shifted(self, by: Point) -> "Piece":
        """The same elsewhere."""
        return replace(
            self,
            start=_sum(self.start, by),
            end=_sum(self.end, by),
            centre=None if self.centre is None else _sum(self.centre, by),
        )

    def swapped(self) -> "Piece":
        """The same with Z and X exchanged, which turns arcs round."""
        return replace(
            self,
            start=(self.start[1], self.start[0]),
            end=(self.end[1], self.end[0]),
            centre=None if self.centre is None else (self.centre[1], self.centre[0]),
            clockwise=not self.clockwise,
        )

    @property
    def stroke(self) -> Stroke:
        """The motion along it."""
        return Stroke(
            end=self.end, rapid=self.rapid, centre=self.centre, clockwise=self.clockwise, line=self.line
        )

    @property
    def turns_back(self) -> bool:
        """Whether one coordinate reverses inside: an arc that passes the end of a quadrant."""
        if self.centre is None:
            return False
        first, last = (
            math.atan2(p[1] - self.centre[1], p[0] - self.centre[0]) for p in (self.start, self.end)
        )
        low, sweep = (last, first - last) if self.clockwise else (first, last - first)
        sweep %= 2.0 * math.pi
        if math.dist(self.start, self.end) < NOTHING:
            sweep = 2.0 * math.pi
        beyond = math.floor((low + NOTHING) / _QUADRANT) + 1
        return beyond * _QUADRANT < low + sweep - NOTHING

    def first_at(self, second: float) -> float:
        """First coordinate where a monotone piece has the second coordinate `second`."""
        rise = self.end[1] - self.start[1]
        if self.centre is None:
            if abs(rise) < NOTHING:
                return self.start[0]
            return self.start[0] + (second - self.start[1]) / rise * (self.end[0] - self.start[0])
        radius = math.dist(self.start, self.centre)
        half = math.sqrt(max(0.0, radius**2 - (second - self.centre[1]) ** 2))
        low, high = sorted((self.start[0], self.end[0]))
        nearest = min((self.centre[0] - half, self.centre[0] + half), key=lambda f: max(low - f, f - high))
        return min(max(nearest, low), high)


def _sum(a: Point, b: Point) -> Point:
    return a[0] + b[0], a[1] + b[1]


def profile_lines(draft: Draft) -> tuple[int, int]:
    """First and last line of the profile by P and Q. PS0061, PS0063, in MDI PS0067."""
    first_word, last_word = draft.take("P"), draft.take("Q")
    code_word = next(iter(draft.block.codes.values()), None)
    if not draft.stored:
        raise draft.alarm("PS0067", str(code_word), code_word)
    if first_word is None or last_word is None:
        missing = "P" if first_word is None else "Q"
        raise draft.alarm("PS0061", f"{code_word} without {missing}", code_word)
    program, start = draft.flow.program, draft.flow.frame.start
    first = program.sequence(draft.reader.natural(first_word), start, draft.index)
    if first is None:
        raise draft.alarm("PS0063", f"N{first_word.text}", first_word)
    last = program.sequence(draft.reader.natural(last_word), start, first - 1)
    if last is None or last < first:
        raise draft.alarm("PS0063", f"N{last_word.text} behind N{first_word.text}", last_word)
    if last - first > MOST_BLOCKS:
        valid = f"at most {MOST_BLOCKS} blocks"
        raise draft.alarm("PS0063", f"a profile of {last - first} lines", last_word, valid=valid)
    return first, last


def read_profile(draft: Draft, first: int, last: int, axes: tuple[int, int]) -> list[Piece]:
    """The profile from the position at the beginning of the block on; `axes` are the columns of Z and X.

    Raises PS0066 for anything but G00 to G03 with X, Z, F and S, PS0065 where the first block is no G00 or
    G01, and what the words themselves raise.
    """
    pieces = list(_pieces(draft, first, last, axes))
    if not pieces:
        raise draft.alarm("PS0065", "a profile without motion", next(iter(draft.block.codes.values()), None))
    return pieces


def _pieces(draft: Draft, first: int, last: int, axes: tuple[int, int]) -> Iterator[Piece]:
    at = {column: draft.position(column) for column in axes}
    modal = draft.modal
    for line in range(first, last + 1):
        block = draft.block_at(line)
        _check_block(block, first=line == first)
        part = replace(
            draft,
            block=block,
            index=line,
            modal=modal,
            at=at,
            rest=dict(block.words),
            commands=[],
            reader=replace(draft.reader, place=block.place),
        )
        for code in block.codes:
            part.set_code(Group.MOTION, code)
        for address in "FS":
            part.take(address)
        motion = part.modal.codes[Group.MOTION]
        (arc if motion in (_G02, _G03) else straight)(part)
        part.refuse_rest()
        modal = part.modal
        for command in part.commands:
            if isinstance(command, (Move, Arc)):
                piece = _piece(command, at, axes, line)
                at = {axes[0]: piece.end[0], axes[1]: piece.end[1]}
                yield piece


def _check_block(block: Block, *, first: bool) -> None:
    place = block.place
    for code, word in block.codes.items():
        if code not in _CODES:
            raise alarm("PS0066", f"{g_name(code)} in the profile", place(word))
    if block.m_code or block.arguments:
        at = place(block.m_word) if block.m_word else block.span
        raise alarm("PS0066", "an M code in the profile", at)
    for address, word in block.words.items():
        if address not in _WORDS:
            raise alarm("PS0066", f"{word} in the profile", place(word))
    if first and not {G00, G01} & block.codes.keys():
        raise alarm("PS0065", "a first block of the profile without G00 or G01", block.span)


def _piece(command: Move | Arc, at: dict[int, float], axes: tuple[int, int], line: int) -> Piece:
    z, x = (
        command.absolute.get(column, at[column] + command.incremental.get(column, 0.0)) for column in axes
    )
    start = (at[axes[0]], at[axes[1]])
    is_arc = isinstance(command, Arc)
    return Piece(
        start=start,
        end=(z, x),
        rapid=not is_arc and command.feed is None,
        centre=_sum(start, command.centre) if is_arc else None,
        clockwise=is_arc and command.clockwise,
        line=line,
    )
