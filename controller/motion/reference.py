"""Which axes know where they are, in which order an inclined pair may find out, and who stands on a reference
point (rulings, section 4; inclined axis, 手动参考点返回操作, 自动参考点返回, 注意 1 to 7)."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import Enum

from controller.laws.inclined import InclinedPair
from controller.span import Span
from controller.tables.alarms import Alarm, alarm

POINTS = 4
"""reference points of an axis (parameters 1240 to 1243)"""


class Reference(Enum):
    """The state of an axis' reference point."""

    MISSING = "not established"
    LOST = "lost by a motion with NOZAGC = 1"
    ESTABLISHED = "established"
    DETACHED = "gone with the axis, which is detached"


_GONE = (Reference.MISSING, Reference.DETACHED)


@dataclass(slots=True)
class References:
    """Reference states of all axes. Absolute encoders everywhere but on an active inclined pair."""

    states: list[Reference]
    pair: InclinedPair | None
    reached: dict[int, int] = field(default_factory=dict)
    """column -> the reference point, 1 to 4, that its last return has brought it to (ZPx, ZP2x to ZP4x)"""
    detached: bool = False
    """whether any axis is detached, or has been and does not know its position yet"""
    due: bool = False
    """the orthogonal axis must return at once: the inclined one has, by hand, and moved it (AZR = 0)"""

    @classmethod
    def at_power_on(cls, axes: int, pair: InclinedPair | None) -> "References":
        """An inclined pair has no references yet, all other axes have. So it is after every change of
        parameters, which are read at power-on (注意 1)."""
        missing = (pair.inclined, pair.orthogonal) if pair else ()
        states = [Reference.MISSING if k in missing else Reference.ESTABLISHED for k in range(axes)]
        return cls(states=states, pair=pair)

    # What an axis must know to move

    def require(self, axis: int, letter: str, span: Span | None) -> None:
        """PS0224 unless the axis may move, PS0009 where it is detached."""
        state = self.states[axis]
        self.require_attached(axis, letter, span)
        if state is Reference.MISSING:
            valid = f"G28 {letter}0 before the block; of an inclined pair the inclined axis first"
            raise alarm("PS0224", f"{letter} without reference point", span, valid=valid)

    def require_attached(self, axis: int, letter: str, span: Span | None) -> None:
        """PS0009 for an axis that is detached: it is as if it were not there."""
        if self.states[axis] is Reference.DETACHED:
            valid = f"an axis that is attached, or signal DTCH{letter} = 0"
            raise alarm("PS0009", f"{letter}, a detached axis", span, valid=valid)

    def check_order(self, axes: Iterable[int], span: Span | None, *, point: int = 1) -> None:
        """DS0020 where the orthogonal axis would return before, or together with, the inclined one; PS0224
        for the 2nd to 4th point (G30) of an axis without its first."""
        axes = tuple(axes)
        if any(self.states[axis] is Reference.DETACHED for axis in axes):
            raise alarm("PS0009", "a detached axis", span, valid="axes that are attached (DTCHx = 0)")
        if self.pair and self.pair.orthogonal in axes:
            inclined, orthogonal = self.states[self.pair.inclined], self.states[self.pair.orthogonal]
            together = self.pair.inclined in axes
            if inclined is not Reference.ESTABLISHED or (
                together and orthogonal is not Reference.ESTABLISHED
            ):
                found = "both axes in one block" if together else "the orthogonal axis first"
                raise alarm("DS0020", f"{found}, the references {inclined.value}", span)
        if point > 1 and any(self.states[axis] is Reference.MISSING for axis in axes):
            found = f"reference point {point} of an axis without its first"
            raise alarm("PS0224", found, span, valid="G28 of the axis before the block")

    def check_orthogonal(self, axes: Iterable[int], span: Span | None, *, inclined_home: bool) -> None:
        """DS0020, at any time, for G27 or a manual return of the orthogonal axis while the inclined one does
        not stand on its reference point (注意 2, 7). `inclined_home`: whether its slide stands there."""
        if not self.pair or self.pair.orthogonal not in axes:
            return
        state = self.states[self.pair.inclined]
        if state is not Reference.ESTABLISHED or not inclined_home:
            where = "not on its reference point" if state is Reference.ESTABLISHED else state.value
            valid = "the inclined axis on its reference point first"
            raise alarm("DS0020", f"the orthogonal axis, the inclined one {where}", span, valid=valid)

    # What a motion changes

    def establish(self, axes: Iterable[int], *, point: int = 1) -> None:
        """The axes have returned to a reference point; the first one makes their positions known."""
        for axis in axes:
            if point == 1:
                self.states[axis] = Reference.ESTABLISHED
            self.reached[axis] = point
        if self.detached:
            self.detached = any(state in _GONE for state in self.states)

    def confirm(self, axes: Iterable[int]) -> None:
        """G27 has found the axes on their first reference points; what was lost stays lost."""
        self.reached.update(dict.fromkeys(axes, 1))

    def leave(self, axes: Iterable[int]) -> None:
        """These axes were commanded to move. Motion that the inclined axis induces in the orthogonal one is
        none of its own: ZPx is a Cartesian signal."""
        for axis in axes:
            self.reached.pop(axis, None)

    def lose(self) -> bool:
        """The inclined axis moved without its compensation; True if that changed anything (注意 5)."""
        if not self.pair or self.states[self.pair.inclined] is not Reference.ESTABLISHED:
            return False
        for axis in (self.pair.inclined, self.pair.orthogonal):
            if self.states[axis] is Reference.ESTABLISHED:
                self.states[axis] = Reference.LOST
            self.leave((axis,))
        return True

    def returned_by_hand(self, axis: int, *, moved_both: bool) -> None:
        """The axis has returned by hand; of the inclined one `moved_both` says whether the orthogonal axis
        went along (AZR = 0), whose own return is due then (注意 3)."""
        self.establish((axis,))
        if self.pair and axis == self.pair.inclined:
            self.due = moved_both

    def overdue(self, span: Span | None, *, returning: Iterable[int] = ()) -> Alarm | None:
        """The warning that something else happens although the orthogonal axis' return is due; once.
        `returning`: the axes that begin their return."""
        if not self.due or self.pair is None:
            return None
        self.due = False
        if self.pair.orthogonal in returning:
            return None
        return Alarm(number="HT9120", found="another action after the return with AZR = 0", span=span)

    def detach(self, axis: int) -> None:
        """DTCHx = 1: the axis is as if it were not there."""
        self.states[axis] = Reference.DETACHED
        self.detached = True
        self.leave((axis,))

    def attach(self, axis: int) -> None:
        """DTCHx = 0 again: the position has to be found anew."""
        if self.states[axis] is Reference.DETACHED:
            self.states[axis] = Reference.MISSING
