"""Program flow: the next block, checked whole, as typed commands.

A block in alarm leaves no trace: modal state and place in the program change only when all of it is good.
Nothing is read ahead: a block is evaluated when it is executed.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import groupby

from controller.commands import Command, Move, ProgramEnd
from controller.language.blocks import interpret_block
from controller.language.draft import Draft
from controller.language.flow import Flow
from controller.language.lexer import OpenWord, Word, lex
from controller.language.macro.functions import Value
from controller.language.macro.run import MacroRunner
from controller.language.macro.statement import Statement, parse_statement
from controller.language.macro.system import SystemVariables
from controller.language.macro.variables import Variables, empty_locals
from controller.language.modal import Modal
from controller.language.offsets import Offsets
from controller.language.plain_lane import Blank, PlainLane
from controller.language.quantities import INCH_DIGITS, METRIC_DIGITS, Reader
from controller.language.source import Program, parse_program
from controller.language.syntax import Block, Line, OpenBlock, build_block, read_line
from controller.motion.motion import Motion
from controller.span import Span
from controller.tables.alarms import Alarm, alarm
from controller.tables.codes import POWER_ON, Group
from controller.tables.machine_data import INCREMENT_LETTER, MachineData

LONGEST_STANDSTILL = 1_000_000
"""blocks without motion before HT9006"""
LARGEST_LABEL = 99_999_999
_MOST_LINES = 4096
"""read lines that are kept for loops and subprograms"""
_G20, _G21 = 200, 210


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """What one block asks for, or one part of a cycle."""

    index: int
    """line of the block, from 0"""
    span: Span
    commands: tuple[Command, ...]
    warnings: tuple[Alarm, ...] = ()


class Interpreter:
    """Reads a program block by block."""

    def __init__(
        self, program: Program, machine: MachineData, offsets: Offsets, signals: Mapping[str, bool]
    ) -> None:
        self.statements = False
        """whether macro statements without a command give steps of their own, for events at their lines"""
        self._program = program
        self._machine = machine
        self._signals = signals
        self._calculator = machine.parameters.bit(3401, 0)
        letters = machine.letters
        self._letters = frozenset(letters) | {INCREMENT_LETTER[k] for k in letters if k in INCREMENT_LETTER}
        self._system = SystemVariables(machine, offsets)
        self._variables = Variables(self._system)
        self._macros = MacroRunner(machine, self._variables, self._system)
        self._flow = Flow(program, self._variables)
        self._lines: dict[int, Line] = {}
        self._lane = PlainLane(machine)
        self._lane_open = self._lane.enter(Modal(tool_shift=offsets.of_tool(None, machine)))
        self._sequel: Iterator[Step] | None = None
        self._still = 0

    @property
    def modal(self) -> Modal:
        """The modal state between blocks."""
        return self._lane.modal

    @property
    def offsets(self) -> Offsets:
        """Work and tool offsets as the program has left them."""
        return self._system.offsets

    @property
    def common(self) -> dict[int, Value]:
        """The common variables that the program has set, by number; None = set to null."""
        return dict(self._variables.common)

    def next(self, motion: Motion) -> Step | None:
        """The next block; None when the program has ended. Raises AlarmError with the block's place.

        Macro statements are executed on the way; one gives a step of its own only where it asks for a
        command.
        """
        if self._sequel is not None:
            step = next(self._sequel, None)
            if step is not None:
                return step
            self._sequel = None
        flow = self._flow
        while not flow.finished:
            index = flow.cursor
            if index >= flow.frame.end:
                return self._text_end(index)
            if self._lane_open and (
                read := self._lane.read(self._program.lines[index], motion.registers.absolute)
            ):
                flow.cursor = index + 1
                if read is Blank.BLANK:
                    continue
                self._count(index)
                return Step(index=index, span=self._program.span(index, 1), commands=(read,))
            line = self._line(index)
            if self._passed_over(line):
                flow.cursor = index + 1
                continue
            self._count(index)
            step = self._run(line, index, motion)
            if step is not None:
                return step
        return None

    def moved(self) -> None:
        """Something has moved: the program is not caught in a loop."""
        self._still = 0

    @property
    def cursor(self) -> int | None:
        """Index of the line that is read next; None inside a cycle."""
        return self._flow.cursor if self._sequel is None and not self._flow.finished else None

    def rewind(self) -> None:
        """The program begins anew; modal states and common variables stay."""
        self._variables.local = empty_locals()
        self._flow = Flow(self._program, self._variables)
        self._sequel = None
        self._still = 0

    def stopped(self, *, in_sync: bool) -> None:
        """RESET or an emergency stop: the program is rewound, spindles out of sync stand."""
        modal = self.modal
        if not in_sync:
            codes = {
                **modal.codes,
                Group.HOBBING: POWER_ON[Group.HOBBING],
                Group.POLYGON: POWER_ON[Group.POLYGON],
            }
            modal = replace(modal, gear=None, sync_rpm=0.0, codes=codes)
        self._enter(replace(modal, direction=0))
        self.rewind()

    def mdi(self, text: str, motion: Motion) -> Step:
        """One block typed by the operator; the place in the program stays.

        Raises AlarmError for what is wrong in it, PS0123 for a macro statement, HT9012 for a call.
        """
        (line, *more) = parse_program(text, file="MDI").lines
        place = Span(file="MDI", line=1, column=1)
        if more:
            raise alarm("HT9012", f"{1 + len(more)} lines", place, valid="one block")
        if statement := parse_statement(line, "MDI", 1):
            raise alarm("PS0123", line.strip()[:20], statement.span)
        words = tuple(lex(line, "MDI", 1))
        block = self._closed(OpenBlock(span=place, words=words, skip=None), motion)
        draft, step = self._interpret(block, self._flow.cursor, motion, stored=False)
        if draft.go is not None:
            raise alarm(
                "HT9012", "a call, a jump or the end of a program", place, valid="one block of motion"
            )
        self._commit(draft)
        return step

    # One block

    def _passed_over(self, line: Line) -> bool:
        """Whether the line is skipped by /n, or asks for nothing."""
        if line.skip is not None:
            self._variables.changes += 1  # the operator may end a loop here
            if self._signals.get(f"BDT{line.skip}", False):
                return True
        return isinstance(line, Block) and line.empty

    def _run(self, line: Line, index: int, motion: Motion) -> Step | None:
        """Carry a line out; None for a macro statement that asks for no command."""
        if not isinstance(line, Statement):
            return self._execute(self._closed(line, motion), index, motion)
        self._system.look(motion, self.modal, self._label)
        commands = self._macros.run(line, index, self._flow, self.modal)
        if not commands and not self.statements:
            return None
        return Step(index=index, span=line.span, commands=commands)

    def _line(self, index: int) -> Line:
        line = self._lines.get(index)
        if line is None:
            line = read_line(self._program, index, self._letters)
            if self._flow.repetitions or not self._flow.main:  # only there a line comes back
                if len(self._lines) >= _MOST_LINES:
                    self._lines.clear()
                self._lines[index] = line
        return line

    def _closed(self, line: Block | OpenBlock, motion: Motion) -> Block:
        """A block with the expressions in it evaluated; a word of the null value is left out."""
        if isinstance(line, Block):
            return line
        self._system.look(motion, self.modal, self._label)
        self._variables.increment_digits = INCH_DIGITS if self.modal.inch else METRIC_DIGITS
        words: list[Word] = []
        for word in line.words:
            if isinstance(word, OpenWord):
                value = word.expression(self._variables)
                if value is not None:
                    words.append(Word(word.address, word.text, word.column, value))
            else:
                words.append(word)
        return build_block(words, line.span, self._letters)

    def _block_at(self, index: int, motion: Motion) -> Block:
        """A line of a profile as a block, empty where it is skipped. Raises PS0066 for a macro statement."""
        line = self._line(index)
        if line.skip is not None and self._signals.get(f"BDT{line.skip}", False):
            return build_block([], self._program.span(index, 1), self._letters)
        if isinstance(line, Statement):
            raise alarm("PS0066", "a macro statement", line.span)
        return self._closed(line, motion)

    def _count(self, index: int) -> None:
        self._still += 1
        if self._still > LONGEST_STANDSTILL:
            raise alarm("HT9006", f"{LONGEST_STANDSTILL} blocks without motion", self._program.span(index, 1))

    def _execute(self, block: Block, index: int, motion: Motion) -> Step:
        """Interpret a block, then let it take effect."""
        draft, step = self._interpret(block, index, motion, stored=True)
        if draft.go is not None:
            draft.go()
        else:
            self._flow.cursor = index + 1
        self._commit(draft)
        return step

    def _interpret(self, block: Block, index: int, motion: Motion, *, stored: bool) -> tuple[Draft, Step]:
        """The block as commands; nothing has changed yet."""
        warnings: list[Alarm] = []
        inch = _G20 in block.codes or (self.modal.inch and _G21 not in block.codes)
        draft = Draft(
            block=block,
            index=index,
            stored=stored,
            machine=self._machine,
            motion=motion,
            flow=self._flow,
            block_at=lambda line: self._block_at(line, motion),
            offsets=self._system.offsets,
            modal=self.modal,
            reader=Reader(inch=inch, calculator=self._calculator, place=block.place, warn=warnings.append),
            rest=dict(block.words),
        )
        interpret_block(draft, optional_stop=self._signals.get("OPTIONAL_STOP", False))
        commands = tuple(draft.commands)
        return draft, Step(index=index, span=block.span, commands=commands, warnings=tuple(warnings))

    def _commit(self, draft: Draft) -> None:
        if draft.modal is not self.modal:
            self._enter(draft.modal)
        self._system.offsets = draft.offsets
        if draft.sequel is not None:
            self._sequel = self._steps(draft.sequel, draft.index)

    def _enter(self, modal: Modal) -> None:
        self._lane_open = self._lane.enter(modal)

    def _steps(self, sequel: Iterator[tuple[int | None, Command]], index: int) -> Iterator[Step]:
        """The parts of a cycle, each at the line of the profile that it comes from."""
        for line, pairs in groupby(sequel, key=lambda pair: index if pair[0] is None else pair[0]):
            for _, command in pairs:
                yield Step(index=line, span=self._program.span(line, 1), commands=(command,))

    # Where the program stands

    def _label(self) -> tuple[int | None, int | None]:
        """#4115, #4114: the O number and the last N number of the program that is being executed."""
        frame = self._flow.frame
        program = next((o for o, k in self._program.starts.items() if frame.start <= k < frame.end), None)
        return program, self._program.label_of(min(self._flow.cursor, frame.end - 1), frame.start)

    # The end

    def _text_end(self, index: int) -> Step:
        """The end of a profile, or of a text without M30, M02 or M99."""
        flow = self._flow
        if home := flow.frame.home:
            back = flow.frame.back - 1
            span = self._program.span(back, 1)
            flow.leave(span)
            move = Move(absolute=home, incremental={}, feed=None, places={})
            return Step(index=back, span=span, commands=(move,))
        last = min(index, len(self._program.lines)) - 1
        span = self._program.span(last)
        if not flow.main:
            raise alarm("PS5010", "the end of a subprogram without M99", span)
        flow.finished = True
        warnings = [Alarm(number="HT9105", found="the end of the text", span=span)]
        if self.modal.gear:
            found = f"the end of the text in {self.modal.gear.kind.value}"
            warnings = [Alarm(number="HT9113", found=found, span=span)]
        return Step(index=last, span=span, commands=(ProgramEnd(),), warnings=tuple(warnings))
