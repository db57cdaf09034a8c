"""The way between lines: subprograms, macro levels, jumps and loops.

A program that goes on for ever without a reason to stop is an alarm: a jump back that arrives with nothing
changed since it arrived there before (HT9011), and any that repeats too often (HT9015).
"""

from dataclasses import dataclass, field

from controller.language.macro.functions import Value
from controller.language.macro.statement import Loop, LoopEnd, matching_end
from controller.language.macro.variables import Variables, empty_locals
from controller.language.source import Program
from controller.span import Span
from controller.tables.alarms import alarm

DEEPEST_NESTING = 10
"""levels of M98"""
DEEPEST_MACROS = 5
"""levels of G65 and G66"""
MOST_REPETITIONS = 200_000
"""jumps back and calls of a program before HT9015"""


@dataclass(slots=True, kw_only=True)
class Frame:
    """A program that is being executed: the main program, a subprogram, a macro, or the profile of G70."""

    start: int
    """index of its first line"""
    end: int
    """index behind its last line"""
    back: int
    """index of the line to go on with in the caller"""
    repeats: int = 0
    """runs that are left after this one"""
    local: list[Value]
    """#1 to #33; those of the caller but for a macro"""
    arguments: dict[int, float] | None = None
    """of a macro, for every run anew; None for any other program"""
    modal: bool = False
    """called by G66 after a motion"""
    home: dict[int, float] | None = None
    """profile of G70: column -> position to return to; None for any other program"""
    loops: dict[int, int] = field(default_factory=dict)
    """index of END -> index of its DO, of loops that have begun"""
    arrivals: dict[int, int] = field(default_factory=dict)
    """target of a jump back -> changes of the variables when it arrived there"""


class Flow:
    """Which line is next."""

    def __init__(self, program: Program, variables: Variables) -> None:
        self.program = program
        self.variables = variables
        self.cursor = 0
        self.repetitions = 0
        self.finished = False
        self._ends: dict[int, int] = {}
        main = Frame(start=0, end=program.end_of(0), back=0, local=variables.local, arrivals={0: 0})
        self.frames = [main]

    @property
    def frame(self) -> Frame:
        """The program that is being executed."""
        return self.frames[-1]

    @property
    def main(self) -> bool:
        """Whether that is the main program."""
        return len(self.frames) == 1

    @property
    def modal_call_running(self) -> bool:
        """Whether a macro of G66 is being executed: it does not call itself."""
        return any(frame.modal for frame in self.frames)

    def finish(self) -> None:
        """M30, M02: the program is over."""
        self.finished = True

    # Calls

    def check_level(self, span: Span, *, macro: bool) -> None:
        """PS0077, PS0122 where one more call would be too deep."""
        macros = sum(frame.arguments is not None for frame in self.frames)
        if macro and macros >= DEEPEST_MACROS:
            raise alarm("PS0122", f"level {macros + 1}", span)
        if not macro and len(self.frames) - macros > DEEPEST_NESTING:
            raise alarm("PS0077", f"level {len(self.frames) - macros}", span)

    def enter(
        self, start: int, *, back: int, repeats: int, arguments: dict[int, float] | None, modal: bool
    ) -> None:
        """Call the program at line `start`; with `arguments` as a macro with variables of its own."""
        local = self.variables.local if arguments is None else _locals(arguments)
        frame = Frame(
            start=start,
            end=self.program.end_of(start),
            back=back,
            repeats=repeats,
            local=local,
            arguments=arguments,
            modal=modal,
        )
        self._push(frame)

    def enter_profile(self, first: int, last: int, *, back: int, home: dict[int, float]) -> None:
        """G70: the lines `first` to `last`, then back to the position `home`."""
        local = self.variables.local
        self._push(Frame(start=first, end=last + 1, back=back, local=local, home=home))

    def _push(self, frame: Frame) -> None:
        self.frames.append(frame)
        self.variables.local = frame.local
        self.cursor = frame.start

    def leave(self, span: Span, target: int | None = None) -> None:
        """M99: the next run of the program, or back to the caller, there to line `target`."""
        frame = self.frame
        if frame.repeats and target is None:
            self.count_repetition(frame.start)
            frame.repeats -= 1
            if frame.arguments is not None:
                frame.local = self.variables.local = _locals(frame.arguments)
            frame.loops.clear()
            frame.arrivals.clear()
            self.cursor = frame.start
            return
        self.frames.pop()
        self.variables.local = self.frame.local
        if target is None:
            self.cursor = frame.back
        else:
            self.jump(target, frame.back - 1, span)

    def go_to(self, line: int) -> None:
        """Go on with a later line."""
        self.cursor = line

    # Jumps

    def jump_to_label(self, number: int, index: int, span: Span) -> None:
        """GOTO: to sequence number N of this program. Raises PS0060, HT9011, HT9015."""
        frame = self.frame
        target = self.program.sequence(number, frame.start, index)
        if target is None:
            raise alarm("PS0060", f"N{number}", span)
        self.jump(target, index, span)

    def jump(self, target: int, index: int, span: Span) -> None:
        """Go on with line `target`. Raises HT9011, HT9015 for a jump back that leads nowhere."""
        if target <= index:
            self.count_repetition(index)
            changes = self.variables.changes
            if self.frame.arrivals.get(target) == changes:
                found = f"a jump back to line {self.program.span(target).line} that nothing ends"
                raise alarm(
                    "HT9011", found, span, valid="a condition that ends the loop, or M30 in place of it"
                )
            self.frame.arrivals[target] = changes
        self.cursor = target

    def count_repetition(self, index: int) -> None:
        """HT9015 after too many of them."""
        self.repetitions += 1
        if self.repetitions > MOST_REPETITIONS:
            found = f"{MOST_REPETITIONS} jumps back and repeated calls"
            raise alarm("HT9015", found, self.program.span(index, 1))

    def begin_loop(self, loop: Loop, index: int, *, holds: bool) -> None:
        """WHILE, DO: into the loop, or behind its END."""
        end = self._ends.get(index)
        if end is None:
            end = self._ends[index] = matching_end(self.program.lines, index, self.frame.end, loop)
        self.frame.loops[end] = index
        self.cursor = index + 1 if holds else end + 1

    def end_loop(self, loop: LoopEnd, index: int) -> None:
        """END: back to its WHILE or DO."""
        begin = self.frame.loops.get(index)
        if begin is None:
            raise alarm("PS0124", f"END{loop.number} without DO{loop.number}", loop.place)
        self.jump(begin, index, loop.place)


def _locals(arguments: dict[int, float]) -> list[Value]:
    local = empty_locals()
    for number, value in arguments.items():
        local[number] = value
    return local
