"""The short lane for what most blocks of a large program are: N, G00 to G03, linear axes, R or I K, F.

It gives exactly what the general way through lexer and interpreter gives, or nothing: whatever it does not
know (another word, code or state, an alarm, a warning) it leaves to the general way. The usual order N G X Z
F is read by one expression, any other order and arcs word by word.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from enum import Enum
from typing import NamedTuple

from controller.commands import Arc, Feed, Move
from controller.language.families.feed_blocks import feed_per_minute, feed_per_revolution
from controller.language.modal import Modal
from controller.language.plain_words import PlainWords, Words, usual_order
from controller.laws.arcs import Point, centre_from_offsets, centre_from_radius
from controller.tables.codes import Group
from controller.tables.machine_data import INCREMENT_LETTER, MachineData

_MOTIONS = {0: "0", 10: "1", 20: "2", 30: "3"}
"""G code in tenths -> its digit"""
_CODES = {digit: code for code, digit in _MOTIONS.items()}
_G18, _G67 = 180, 670
_MOST_FEEDS = 1000
"""feeds kept at hand"""


class Blank(Enum):
    """A line that asks for nothing."""

    BLANK = "blank"


class PlainLane:
    """Reads plain blocks: `enter` with a modal state, then `read` line by line; `modal` follows."""

    def __init__(self, machine: MachineData) -> None:
        columns = [k for k, axis in enumerate(machine.axes) if not axis.rotary]
        letters = [machine.axes[k].letter for k in columns]
        self._free = machine.pair is None and machine.together >= len(columns)
        counted = not machine.parameters.bit(3401, 0)
        self._match, groups = usual_order(letters, counted=counted)
        self._axes = tuple(
            (group, k, machine.axes[k].factor) for group, k in zip(groups, columns, strict=True)
        )
        self._words = PlainWords(letters, counted=counted)
        self._columns: dict[str, tuple[int, float, bool]] = {}
        """axis or increment letter -> column, factor, whether it is an increment"""
        for letter, k in zip(letters, columns, strict=True):
            self._columns[letter] = k, machine.axes[k].factor, False
            if letter in INCREMENT_LETTER:
                self._columns[INCREMENT_LETTER[letter]] = k, machine.axes[k].factor, True
        plane = machine.basic.get("Z"), machine.basic.get("X")
        self._plane = None if plane[0] is None or plane[1] is None else (plane[0], plane[1])
        self._tolerance = machine.parameters.number(3410)
        work = machine.work_spindle
        self._measured = work is not None and machine.axes[work].encoder
        self._base = self._modal = Modal()
        """the state entered with, and a later one"""
        self._state = self._state_of_modal = _State("0", None)
        self._feeds: dict[str | None, Feed | None] = {}
        """F since `enter` -> feed of a cut; None where the general way has to look at it"""

    @property
    def modal(self) -> Modal:
        """As the last block left it."""
        if self._state is not self._state_of_modal:
            self._state_of_modal = self._state
            self._modal = self._modal_of(self._state)
        return self._modal

    def enter(self, modal: Modal) -> bool:
        """Take a modal state over; False where it is none for plain blocks."""
        self._base = self._modal = modal
        motion = modal.codes[Group.MOTION]
        self._state = self._state_of_modal = _State(_MOTIONS.get(motion, "0"), None)
        self._feeds = {None: self._feed_of(modal.feed, inch=modal.feed_inch)}
        return (
            self._free
            and modal.gear is None
            and not modal.inch
            and motion in _MOTIONS
            and modal.codes[Group.MACRO] == _G67
        )

    def read(self, line: str, shown: Sequence[float]) -> Move | Arc | Blank | None:
        """The motion of a plain block that begins at absolute positions `shown` (axes,); None where the line
        is not certainly one."""
        found = self._match(line)
        if found is None:
            return self._read_words(line, shown)
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
        motion, feed_text = words[0], words[-1]
        if not places:
            return Blank.BLANK if motion is None and feed_text is None else None
        return self._move(self._after(motion, feed_text), absolute, incremental, places)

    def _after(self, motion: str | None, feed_text: str | None) -> "_State":
        """The state that a block leaves."""
        state = self._state
        if (motion is None or motion == state.motion) and (feed_text is None or feed_text == state.feed):
            return state
        return _State(motion or state.motion, feed_text or state.feed)

    def _move(
        self,
        state: "_State",
        absolute: dict[int, float],
        incremental: dict[int, float],
        places: dict[int, int],
    ) -> Move | None:
        """The straight move; None where the motion in force is an arc, or there is no feed."""
        feed = None
        if state.motion != "0":
            feed = self._feed(state.feed)
            if feed is None or state.motion != "1":
                return None
        self._state = state
        return Move(absolute=absolute, incremental=incremental, feed=feed, places=places)

    # Any order

    def _read_words(self, line: str, shown: Sequence[float]) -> Move | Arc | Blank | None:
        words = self._words.read(line)
        if words is None:
            return None
        motion, _ = words.pop("G", _NO_WORD)
        feed_text, _ = words.pop("F", _NO_WORD)
        if not words:
            return Blank.BLANK if motion is None and feed_text is None else None
        circle = {letter: words.pop(letter)[0] for letter in "IKR" if letter in words}
        targets = self._targets(words)
        if targets is None:
            return None
        state = self._after(motion, feed_text)
        if state.motion < "2":
            return None if circle else self._move(state, *targets)
        return self._arc(state, targets, circle, shown) if circle else None

    def _targets(self, words: Words) -> "_Targets | None":
        """The axis words; None where there are none, or two for one axis."""
        targets = _Targets({}, {}, {})
        for letter, (text, place) in words.items():
            column, factor, increment = self._columns[letter]
            if column in targets.places:
                return None
            (targets.incremental if increment else targets.absolute)[column] = float(text) / factor
            targets.places[column] = place
        return targets if words else None

    def _arc(
        self, state: "_State", targets: "_Targets", circle: Mapping[str, str], shown: Sequence[float]
    ) -> Arc | None:
        feed, plane, clockwise = self._feed(state.feed), self._plane, state.motion == "2"
        if plane is None or feed is None or self._base.codes[Group.PLANE] != _G18:
            return None
        if not targets.places.keys() <= set(plane):
            return None
        end = targets.travel(plane[0], shown), targets.travel(plane[1], shown)
        centre = self._centre(end, circle, clockwise=clockwise)
        if centre is None:
            return None
        self._state = state
        absolute, incremental, places = targets
        return Arc(
            absolute=absolute,
            incremental=incremental,
            plane=plane,
            centre=centre,
            clockwise=clockwise,
            feed=feed,
            places=places,
        )

    def _centre(self, end: Point, circle: Mapping[str, str], *, clockwise: bool) -> Point | None:
        if "R" not in circle:
            offsets = float(circle.get("K", "0")), float(circle.get("I", "0"))
            return centre_from_offsets(offsets, end, tolerance=self._tolerance)
        if len(circle) > 1:
            return None
        radius = float(circle["R"])
        return centre_from_radius(end, radius, clockwise=clockwise, tolerance=self._tolerance)

    # Modal states

    def _modal_of(self, state: "_State") -> Modal:
        """The state entered with, with another motion code and another feed."""
        modal, code = self._base, _CODES[state.motion]
        if modal.codes[Group.MOTION] != code:
            modal = replace(modal, codes={**modal.codes, Group.MOTION: code})
        return modal if state.feed is None else replace(modal, feed=float(state.feed), feed_inch=False)

    def _feed(self, text: str | None) -> Feed | None:
        if text not in self._feeds:
            if len(self._feeds) >= _MOST_FEEDS:
                self._feeds = {None: self._feeds[None]}
            self._feeds[text] = self._feed_of(float(text or 0), inch=False)
        return self._feeds[text]

    def _feed_of(self, value: float | None, *, inch: bool) -> Feed | None:
        """The feed of a cut by an F in the state entered with; None where the general way has to look."""
        if not value:
            return None
        if not self._base.per_revolution:
            return feed_per_minute(value, inch=inch)
        if not (self._base.direction and self._measured):
            return None
        return feed_per_revolution(value, inch=inch, measured=True)


class _State(NamedTuple):
    """What plain blocks change of the modal state."""

    motion: str
    """digit of G00 to G03"""
    feed: str | None
    """number of F; None = as it was entered with"""


class _Targets(NamedTuple):
    """Where a block goes: by column, absolutely and by increments; and the text columns of the words."""

    absolute: dict[int, float]
    incremental: dict[int, float]
    places: dict[int, int]

    def travel(self, column: int, shown: Sequence[float]) -> float:
        """From the start to the end on one axis."""
        if column in self.absolute:
            return self.absolute[column] - shown[column]
        return self.incremental.get(column, 0.0)


_NO_WORD = (None, 0)
_INCREMENTS = frozenset(INCREMENT_LETTER.values())
