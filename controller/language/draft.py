"""A block on its way to commands: words are taken one by one, and what is left over is an alarm."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace

from controller.commands import Command
from controller.language.flow import Flow
from controller.language.lexer import Word
from controller.language.modal import Modal
from controller.language.offsets import Offsets
from controller.language.quantities import Reader
from controller.language.syntax import Block
from controller.laws.gearbox import SyncKind
from controller.motion.motion import Motion
from controller.tables.alarms import Alarm, AlarmError, alarm
from controller.tables.codes import Group, g_name
from controller.tables.machine_data import INCREMENT_LETTER, MachineData

LONGEST_MOVE = 99999.999
"""[mm | deg] PS5007 beyond"""


@dataclass(slots=True, kw_only=True)
class Draft:
    """One block being checked. Nothing outside changes until all of it has been."""

    block: Block
    index: int
    """its line"""
    stored: bool
    """whether it stands in a program; not one of MDI"""
    flow: Flow
    block_at: Callable[[int], Block]
    """another line of the program as a block; PS0066 for a macro statement"""
    machine: MachineData
    motion: Motion
    """the state of the machine at the beginning of the block; only read"""
    offsets: Offsets
    """as the block will leave them"""
    modal: Modal
    """as the block will leave it"""
    at: Mapping[int, float] | None = None
    """column -> position to start from, in a profile that is only read; None = where the axes are"""
    reader: Reader
    commands: list[Command] = field(default_factory=list)
    sequel: Iterator[tuple[int | None, Command]] | None = None
    """commands of a cycle, behind `commands`: index of the profile's line (None = of the block), command"""
    go: Callable[[], None] | None = None
    """takes the place of going on with the next line"""
    rest: dict[str, Word] = field(default_factory=dict)
    """words not yet taken"""

    def take(self, address: str) -> Word | None:
        """A word of the block, once."""
        return self.rest.pop(address, None)

    def refuse_rest(self) -> None:
        """PS0009 for a word that has no meaning in this block: nothing is ever ignored."""
        for word in self.rest.values():
            names = ", ".join(g_name(code) for code in self.block.codes) or "this block"
            taken = _TAKEN_BY.get(word.address)
            valid = f"a block without {word.address}" + (f"; it belongs to {taken}" if taken else "")
            raise self.alarm("PS0009", f"{word}, which means nothing with {names}", word, valid=valid)

    def alarm(self, number: str, found: str, word: Word | None = None, *, valid: str = "") -> AlarmError:
        """An alarm at a word, or at the block."""
        return alarm(number, found, self.block.place(word) if word else self.block.span, valid=valid)

    def warn(self, number: str, found: str, word: Word | None = None) -> None:
        """A warning at a word, or at the block."""
        self.reader.warn(
            Alarm(number=number, found=found, span=self.block.place(word) if word else self.block.span)
        )

    def code_word(self, code: int) -> Word | None:
        """The word of a G code of this block."""
        return self.block.codes.get(code)

    def set_code(self, group: Group, code: int) -> None:
        """Put a modal G code in force."""
        if self.modal.codes[group] != code:
            self.modal = replace(self.modal, codes={**self.modal.codes, group: code})

    def remember_m_code(self, number: int) -> None:
        """The last M code, for #4113."""
        self.modal = replace(self.modal, m_code=number)

    def refuse_in_sync(self, found: str, word: Word | None = None, *, valid: str = "") -> None:
        """PS1595 while hobbing, PS0220 in polygon turning, for what sync forbids."""
        if self.modal.gear:
            raise self.alarm(
                _FORBIDDEN[self.modal.gear.kind],
                f"{found} in {self.modal.gear.kind.value}",
                word,
                valid=valid,
            )

    def refuse_sync_axes(self, words: dict[int, Word], name: str) -> None:
        """PS1595, PS0220 for a command `name` on the master or the slave."""
        gear = self.modal.gear
        for column, word in words.items():
            if gear and column in (gear.master, gear.slave):
                self.refuse_in_sync(f"{name} of {word}", word)

    def refuse_analogue(self, column: int, word: Word | None) -> None:
        """PS0197 for a reference return, or the orientation, of a spindle without position control."""
        if self.machine.axes[column].analogue:
            found = f"{word} of {self.letter(column)}, an analogue spindle"
            raise self.alarm("PS0197", found, word, valid="a servo axis (parameter 9005#0 = 0)")

    def letter(self, column: int) -> str:
        """Axis letter of a column."""
        return self.machine.axes[column].letter

    def axis_words(self) -> tuple[dict[int, Word], dict[int, Word]]:
        """Take all axis words: column -> word, absolute and incremental. PS5074 for both on one axis."""
        absolute: dict[int, Word] = {}
        incremental: dict[int, Word] = {}
        if not self.rest:
            return absolute, incremental
        for column, axis in enumerate(self.machine.axes):
            if word := self.take(axis.letter):
                absolute[column] = word
            increment = INCREMENT_LETTER.get(axis.letter)
            if increment and (word := self.take(increment)):
                if column in absolute:
                    raise self.alarm("PS5074", f"{word} beside {absolute[column]}", word)
                incremental[column] = word
        return absolute, incremental

    def check_together(self, words: Mapping[int, Word]) -> None:
        """PS0015 for more axes than the control moves together."""
        most = self.machine.together
        if len(words) > most:
            *_, last = sorted(words.values(), key=lambda word: word.column)
            found = f"{last}, one of {len(words)} axes"
            raise self.alarm("PS0015", found, last, valid=f"at most {most} axes in a block (parameter 9004)")

    def axis_value(self, column: int, word: Word) -> float:
        """The number of an axis word as slide travel [mm | deg]. PS5007 where it is too large."""
        axis = self.machine.axes[column]
        value = self.reader.angle(word) if axis.rotary else self.reader.length(word) / axis.factor
        if abs(value) > LONGEST_MOVE:
            raise self.alarm("PS5007", str(word), word, valid=f"within {LONGEST_MOVE:g}")
        return value

    def position(self, column: int) -> float:
        """Work coordinate at the beginning of the block as slide travel [mm | deg]."""
        if self.at is not None and column in self.at:
            return self.at[column]
        return float(self.motion.registers.absolute[column])


_TAKEN_BY = {
    "A": "G51.2",
    "I": "G02, G03, G22",
    "J": "G02, G03, G22",
    "K": "G02, G03, G22",
    "L": "G10, G65, G66, G81, M98",
    "P": "G04, G10, G30, G51.2, G65, G66, G70 to G76, G81, M98, M99",
    "Q": "G10, G32, G51.2, G70 to G76, G81, G92",
    "R": "G02, G03, G10, G51.2, G71 to G76, G90, G92, G94",
}
"""address -> the codes it means something with"""
_FORBIDDEN = {SyncKind.HOBBING: "PS1595", SyncKind.POLYGON: "PS0220"}
