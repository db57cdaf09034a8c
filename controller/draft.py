"""A block on its way to commands: words are taken one by one, and what is left over is an alarm."""

from dataclasses import dataclass, field, replace

from controller.alarms import Alarm, AlarmError, alarm
from controller.codes import Group, g_name
from controller.commands import Command
from controller.gearbox import SyncKind
from controller.lexer import Word
from controller.machine_data import INCREMENT_LETTER, MachineData
from controller.modal import Modal
from controller.motion import Motion
from controller.offsets import Offsets
from controller.quantities import Reader
from controller.syntax import Block


@dataclass(slots=True, kw_only=True)
class Draft:
    """One block being checked. Nothing outside changes until all of it has been."""

    block: Block
    machine: MachineData
    motion: Motion
    """the state of the machine at the beginning of the block; only read"""
    offsets: Offsets
    modal: Modal
    """as the block will leave it"""
    reader: Reader
    commands: list[Command] = field(default_factory=list)
    rest: dict[str, Word] = field(default_factory=dict)
    """words not yet taken"""

    def take(self, address: str) -> Word | None:
        """A word of the block, once."""
        return self.rest.pop(address, None)

    def refuse_rest(self) -> None:
        """PS0009 for a word that has no meaning in this block: nothing is ever ignored."""
        for word in self.rest.values():
            names = ", ".join(g_name(code) for code in self.block.codes) or "this block"
            raise self.alarm(
                "PS0009", f"{word}, which means nothing with {names}", word, valid="no such word here"
            )

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
        self.modal = replace(self.modal, codes={**self.modal.codes, group: code})

    def refuse_in_sync(self, found: str, word: Word | None = None, *, valid: str = "") -> None:
        """PS1595 while hobbing, PS0220 in polygon turning, for what sync forbids."""
        if self.modal.gear:
            raise self.alarm(
                _FORBIDDEN[self.modal.gear.kind],
                f"{found} in {self.modal.gear.kind.value}",
                word,
                valid=valid,
            )

    def letter(self, column: int) -> str:
        """Axis letter of a column."""
        return self.machine.axes[column].letter

    def axis_words(self) -> tuple[dict[int, Word], dict[int, Word]]:
        """Take all axis words: column -> word, absolute and incremental. PS5074 for both on one axis."""
        absolute: dict[int, Word] = {}
        incremental: dict[int, Word] = {}
        for column, axis in enumerate(self.machine.axes):
            if word := self.take(axis.letter):
                absolute[column] = word
            increment = INCREMENT_LETTER.get(axis.letter)
            if increment and (word := self.take(increment)):
                if column in absolute:
                    raise self.alarm("PS5074", f"{word} beside {absolute[column]}", word)
                incremental[column] = word
        return absolute, incremental

    def axis_value(self, column: int, word: Word) -> float:
        """The number of an axis word as slide travel [mm | deg]."""
        axis = self.machine.axes[column]
        return self.reader.angle(word) if axis.rotary else self.reader.length(word) / axis.factor


_FORBIDDEN = {SyncKind.HOBBING: "PS1595", SyncKind.POLYGON: "PS0220"}
