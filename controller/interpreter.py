"""Program flow: the next block, checked whole, as typed commands; subprograms, ends, the way between lines.

A block in alarm leaves no trace: modal state and place in the program change only when all of it is good.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from controller.alarms import Alarm, alarm
from controller.codes import G_CODES, Group
from controller.commands import Command, Coolant, ProgramEnd, ProgramStop
from controller.draft import Draft
from controller.machine_data import INCREMENT_LETTER, MachineData
from controller.modal import Modal
from controller.motion import Motion
from controller.motion_blocks import (
    interpret_feed,
    interpret_motion,
    interpret_tool,
    interpret_work_offset,
)
from controller.offsets import Offsets
from controller.quantities import Reader
from controller.source import Program
from controller.span import Span
from controller.spindle_blocks import interpret_spindle, stop_spindle
from controller.sync_blocks import interpret_sync
from controller.syntax import Block, parse_block

DEEPEST_NESTING = 10
LONGEST_STANDSTILL = 1_000_000
"""blocks without motion before HT9006"""
_G20, _G21 = 200, 210
_END = -1
"""in place of a line: the program is over"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """What one block asks for."""

    index: int
    """line of the block, from 0"""
    span: Span
    commands: tuple[Command, ...]
    warnings: tuple[Alarm, ...]


@dataclass(frozen=True, slots=True)
class _Frame:
    """A program that is being executed."""

    start: int
    """index of its first line"""
    end: int
    """index behind its last line"""
    repeats: int
    """runs that are left after this one"""
    back: int
    """index of the line to go on with in the caller"""


class Interpreter:
    """Reads a program block by block."""

    def __init__(
        self, program: Program, machine: MachineData, offsets: Offsets, signals: Mapping[str, bool]
    ) -> None:
        self.modal = Modal()
        self._program = program
        self._machine = machine
        self._offsets = offsets
        self._signals = signals
        letters = machine.letters
        self._letters = frozenset(letters) | {INCREMENT_LETTER[k] for k in letters if k in INCREMENT_LETTER}
        self._frames = [
            _Frame(0, min((k for k in sorted(program.starts.values())[1:]), default=len(program.lines)), 0, 0)
        ]
        self._parsed: dict[int, Block] = {}
        self._cursor = 0
        self._still = 0
        self._finished = False

    def next(self, motion: Motion) -> Step | None:
        """The next block; None when the program has ended. Raises AlarmError with the block's place."""
        if self._finished:
            return None
        while self._cursor < self._frames[-1].end:
            index = self._cursor
            block = self._parsed.get(index) or parse_block(self._program, index, self._letters)
            if len(self._frames) > 1:
                self._parsed[index] = block  # a subprogram is read again and again
            if block.empty or self._skipped(block):
                self._cursor += 1
                continue
            self._count(index)
            return self._read(block, index, motion)
        return self._text_end()

    def moved(self) -> None:
        """Something has moved: the program is not caught in a loop."""
        self._still = 0

    def _skipped(self, block: Block) -> bool:
        return block.skip is not None and self._signals.get(f"BDT{block.skip}", False)

    def _count(self, index: int) -> None:
        self._still += 1
        if self._still > LONGEST_STANDSTILL:
            raise alarm("HT9006", f"{LONGEST_STANDSTILL} blocks without motion", self._program.span(index, 1))

    def _read(self, block: Block, index: int, motion: Motion) -> Step:
        """Interpret a block, then let it take effect."""
        warnings: list[Alarm] = []
        codes = dict(self.modal.codes)
        inch = _G20 in block.codes or (self.modal.inch and _G21 not in block.codes)
        reader = Reader(
            inch=inch,
            calculator=self._machine.parameters.bit(3401, 0),
            place=block.place,
            warn=warnings.append,
        )
        draft = Draft(
            block=block,
            machine=self._machine,
            motion=motion,
            offsets=self._offsets,
            modal=self.modal,
            reader=reader,
            rest=dict(block.words),
        )
        flow = None
        if not interpret_sync(draft):
            self._set_codes(draft)
            interpret_tool(draft)
            interpret_work_offset(draft, codes[Group.WORK_OFFSET])
            interpret_spindle(draft)
            interpret_feed(draft, codes[Group.FEED])
            flow = self._call(draft, index)
            interpret_motion(draft)
            self._finish_block(draft)
        draft.refuse_rest()
        self.modal = draft.modal
        self._go(flow, index)
        return Step(index=index, span=block.span, commands=tuple(draft.commands), warnings=tuple(warnings))

    def _set_codes(self, draft: Draft) -> None:
        for tenths, word in draft.block.codes.items():
            if tenths in (_G20, _G21):
                draft.refuse_in_sync(str(word), word)
            if G_CODES[tenths].group is not Group.ONE_SHOT:
                draft.set_code(G_CODES[tenths].group, tenths)

    def _finish_block(self, draft: Draft) -> None:
        """The M codes that act after the motion, and coolant."""
        number = draft.block.m_code.number if draft.block.m_code else None
        if number in (0, 1):
            if number == 0 or self._signals.get("OPTIONAL_STOP", False):
                draft.warn("HT9109", f"M{number:02d}")
                draft.commands.append(ProgramStop(span=draft.block.span))
        elif number in (2, 30):
            draft.refuse_in_sync(f"M{number:02d}")
            draft.commands.append(ProgramEnd())
        elif number == 5:
            stop_spindle(draft)
        elif number in (8, 9):
            draft.commands.append(Coolant(on=number == 8))

    # The way between lines

    def _call(self, draft: Draft, index: int) -> _Frame | int | None:
        """M98 and M99: the frame to enter, or the line to go to."""
        number = draft.block.m_code.number if draft.block.m_code else None
        if number == 98:
            return self._subprogram(draft, index)
        if number == 99:
            return self._return(draft, index)
        if number in (2, 30):
            return _END
        return None

    def _subprogram(self, draft: Draft, index: int) -> _Frame:
        """M98 P1234 L5, or in the old form M98 P51234."""
        word, times = draft.take("P"), draft.take("L")
        if word is None:
            raise draft.alarm("PS0076", "M98 without P", valid="P and the O number")
        value = draft.reader.natural(word)
        repeats = draft.reader.natural(times) if times else 1
        if times is None and value not in self._program.starts and value > 9999:
            repeats, value = divmod(value, 10_000)
        start = self._program.starts.get(value)
        if start is None:
            known = ", ".join(f"O{number:04d}" for number in sorted(self._program.starts)[:10]) or "none"
            raise draft.alarm("PS0076", str(word), word, valid=f"an O number of this file: {known}")
        if len(self._frames) > DEEPEST_NESTING:
            raise draft.alarm("PS0077", f"level {len(self._frames)}", word)
        if repeats == 0:
            raise draft.alarm("HT9012", str(times or word), times or word, valid="at least one run")
        return _Frame(start, self._program.end_of(start), repeats - 1, index + 1)

    def _return(self, draft: Draft, index: int) -> int:
        """M99: the line to go on with. In the main program it would begin anew without end."""
        word = draft.take("P")
        frame, main = self._frames[-1], len(self._frames) == 1
        target = None
        if word:
            home = self._frames[-2] if not main else frame
            target = self._program.sequence(draft.reader.natural(word), home.start)
            if target is None:
                raise draft.alarm("PS0060", f"N{word.text}", word)
        if main and (target is None or target <= index):
            raise draft.alarm("HT9011", "M99 that begins the main program anew", word)
        if main and target is not None:
            return target
        if frame.repeats and target is None:
            return frame.start
        return frame.back if target is None else target

    def _go(self, flow: _Frame | int | None, index: int) -> None:
        """Commit the place in the program."""
        if flow is None:
            self._cursor = index + 1
        elif isinstance(flow, _Frame):
            self._frames.append(flow)
            self._cursor = flow.start
        elif flow == _END:
            self._finished = True
        else:
            self._leave(flow)
            self._cursor = flow

    def _leave(self, target: int) -> None:
        """M99: stay for another run, or go back to the caller."""
        frame = self._frames[-1]
        if len(self._frames) == 1:
            return
        if frame.repeats and target == frame.start:
            self._frames[-1] = replace(frame, repeats=frame.repeats - 1)
        else:
            self._frames.pop()

    def _text_end(self) -> Step:
        """The text ends without M30, M02 or M99."""
        index = len(self._program.lines) - 1
        span = self._program.span(min(self._frames[-1].end, len(self._program.lines)) - 1)
        if len(self._frames) > 1:
            raise alarm("PS5010", "the end of a subprogram without M99", span)
        self._finished = True
        warnings = [Alarm(number="HT9105", found="the end of the text", span=span)]
        if self.modal.gear:
            found = f"the end of the text in {self.modal.gear.kind.value}"
            warnings = [Alarm(number="HT9113", found=found, span=span)]
        return Step(index=index, span=span, commands=(ProgramEnd(),), warnings=tuple(warnings))
