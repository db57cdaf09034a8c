"""The short lane for what most blocks of a large program are: N, G00 or G01, linear axes, F, in this order.

It gives exactly what the general way through lexer and interpreter gives, or nothing: whatever it does not
know (another word, code or state, an alarm, a warning) it leaves to the general way.
"""

import re
from dataclasses import replace

from controller.commands import Feed, Move
from controller.language.families.feed_blocks import feed_per_minute, feed_per_revolution
from controller.language.families.straight_blocks import G00, G01
from controller.language.modal import Modal
from controller.tables.codes import Group
from controller.tables.machine_data import INCREMENT_LETTER, MachineData

_G67 = 670
_MOST_VARIANTS = 1000
"""feeds kept at hand"""


class PlainLane:
    """Reads plain blocks: `enter` with a modal state, then `read` line by line; `modal` follows."""

    def __init__(self, machine: MachineData) -> None:
        self.modal = Modal()
        """as the last block left it"""
        self._calculator = machine.parameters.bit(3401, 0)
        columns = [k for k, axis in enumerate(machine.axes) if not axis.rotary]
        self._free = machine.pair is None and machine.together >= len(columns)
        pattern, groups = _pattern([machine.axes[k].letter for k in columns], self._calculator)
        self._match = re.compile(pattern, re.ASCII).fullmatch
        self._axes = tuple(
            (group, k, machine.axes[k].factor) for group, k in zip(groups, columns, strict=True)
        )
        self._base = self.modal
        self._state: tuple[str, str | None] = ("0", None)
        self._feed: Feed | None = None
        work = machine.work_spindle
        self._measured = work is not None and machine.axes[work].encoder
        self._variants: dict[tuple[str, str | None], tuple[Modal, Feed | None]] = {}

    def enter(self, modal: Modal) -> bool:
        """Take a modal state over; False where it is none for plain blocks."""
        self.modal = self._base = modal
        self._variants.clear()
        motion = modal.codes[Group.MOTION]
        self._state = ("1" if motion == G01 else "0", None)
        self._feed = self._feed_of(modal)
        return (
            self._free
            and modal.gear is None
            and not modal.inch
            and motion in (G00, G01)
            and modal.codes[Group.MACRO] == _G67
        )

    def read(self, line: str) -> Move | None:
        """The move of a plain block; None where the line is not certainly one."""
        found = self._match(line)
        if found is None:
            return None
        words = found.groups()
        absolute: dict[int, float] = {}
        incremental: dict[int, float] = {}
        places: dict[int, int] = {}
        for group, column, factor in self._axes:
            letter = words[group]
            if letter is not None:
                value = float(words[group + 1]) / factor
                if letter in _INCREMENTS:
                    incremental[column] = value
                else:
                    absolute[column] = value
                places[column] = found.start(group + 1) + 1
        state = (words[0] or self._state[0], words[-1] or self._state[1])
        modal, feed = self.modal, self._feed
        if state != self._state:
            modal, feed = self._variants.get(state) or self._variant(state)
        rapid = state[0] == "0"
        if not places or (feed is None and not rapid):
            return None
        self._state, self.modal, self._feed = state, modal, feed
        return Move(absolute=absolute, incremental=incremental, feed=None if rapid else feed, places=places)

    def _variant(self, state: tuple[str, str | None]) -> tuple[Modal, Feed | None]:
        """The state entered with, with another motion code and another feed."""
        modal = self._base
        code, text = (G01 if state[0] == "1" else G00), state[1]
        if modal.codes[Group.MOTION] != code:
            modal = replace(modal, codes={**modal.codes, Group.MOTION: code})
        if text is not None:
            modal = replace(modal, feed=float(text), feed_inch=False)
        if len(self._variants) >= _MOST_VARIANTS:
            self._variants.clear()
        variant = self._variants[state] = (modal, self._feed_of(modal))
        return variant

    def _feed_of(self, modal: Modal) -> Feed | None:
        """The feed of a G01 in this state; None where the general way has to look at it."""
        if not modal.feed:
            return None
        if not modal.per_revolution:
            return feed_per_minute(modal, linear=True)
        if not (modal.direction and self._measured):
            return None
        return feed_per_revolution(modal, linear=True, measured=True)


_INCREMENTS = frozenset(INCREMENT_LETTER.values())


def _pattern(letters: list[str], calculator: bool) -> tuple[str, list[int]]:
    """The form of a plain block, and the groups of the axis letters; each number is the group behind."""
    length = r"\d{1,5}(?:\.\d{0,3})?|\.\d{1,3}" if calculator else r"\d{1,5}\.\d{0,3}|\.\d{1,3}"
    last = r"(?![\d.+-])[ \t]*"
    pattern = rf"[ \t]*(?:N[ \t]*\d{{1,8}}{last})?(?:G0?([01]){last})?"
    groups = []
    for k, letter in enumerate(letters):
        pair = letter + INCREMENT_LETTER.get(letter, "")
        pattern += rf"(?:([{pair}])[ \t]*([+-]?(?:{length})){last})?"
        groups.append(1 + 2 * k)
    return pattern + rf"(?:F[ \t]*({length}){last})?(?:\([^)]*\)[ \t]*)?(?:[;；].*)?", groups
