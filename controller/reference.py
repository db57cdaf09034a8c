"""Which axes know where they are, and in which order an inclined pair may find out (rulings, section 4)."""

from dataclasses import dataclass
from enum import Enum

from controller.alarms import alarm
from controller.inclined import InclinedPair
from controller.span import Span


class Reference(Enum):
    """The state of an axis' reference point."""

    MISSING = "not established"
    LOST = "lost by a motion with NOZAGC = 1"
    ESTABLISHED = "established"


@dataclass(slots=True)
class References:
    """Reference states of all axes. Absolute encoders everywhere but on an active inclined pair."""

    states: list[Reference]
    pair: InclinedPair | None

    @classmethod
    def at_power_on(cls, axes: int, pair: InclinedPair | None) -> "References":
        """An inclined pair has no references yet, all other axes have."""
        missing = (pair.inclined, pair.orthogonal) if pair else ()
        states = [Reference.MISSING if k in missing else Reference.ESTABLISHED for k in range(axes)]
        return cls(states=states, pair=pair)

    def require(self, axis: int, letter: str, span: Span | None) -> None:
        """PS0224 unless the axis may move."""
        if self.states[axis] is Reference.MISSING:
            valid = f"G28 {letter}0 before the block; of an inclined pair the inclined axis first"
            raise alarm("PS0224", f"{letter} without reference point", span, valid=valid)

    def check_order(self, axes: tuple[int, ...], span: Span) -> None:
        """DS0020 where the orthogonal axis would return before, or together with, the inclined one."""
        if not self.pair or self.pair.orthogonal not in axes:
            return
        inclined = self.states[self.pair.inclined]
        orthogonal = self.states[self.pair.orthogonal]
        pending = inclined is not Reference.ESTABLISHED
        together = self.pair.inclined in axes and orthogonal is not Reference.ESTABLISHED
        if pending or together:
            found = "both axes in one block" if self.pair.inclined in axes else "the orthogonal axis first"
            raise alarm("DS0020", f"{found}, the references {inclined.value}", span)

    def establish(self, axes: tuple[int, ...]) -> None:
        """The axes have reached their reference points."""
        for axis in axes:
            self.states[axis] = Reference.ESTABLISHED

    def lose(self) -> bool:
        """The inclined axis moved without its compensation; True if that changed anything."""
        if not self.pair or self.states[self.pair.inclined] is Reference.LOST:
            return False
        self.states[self.pair.inclined] = self.states[self.pair.orthogonal] = Reference.LOST
        return True
