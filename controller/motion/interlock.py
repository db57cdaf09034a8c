"""Signals that let a block move or hold it back (inclined axis, 本功能与各轴输入输出信号之间的关系)."""

from collections.abc import Iterable

from controller.laws.inclined import InclinedPair
from controller.span import Span
from controller.tables.alarms import Alarm
from controller.tables.signals import SIGNALS, AxisInput, Inputs

_OF_COMMAND, _OF_SLIDE = AxisInput.INTERLOCK, AxisInput.SERVO_OFF


def holds_back(inputs: Inputs, commanded: Iterable[int], moving: Iterable[int]) -> str | None:
    """What a block waits for, such as "*ITX = 1"; None = it may move.

    `commanded` are the columns of the axes that the block names: each waits for its interlock *ITx, and all
    axes of the block with it. `moving` are the columns of the slides that it moves, induced motion included:
    a slide without servo (SVFx = 1) cannot follow, so nothing moves until it has one again.
    """
    if not inputs.levels:
        return None
    for kind, columns in ((_OF_COMMAND, commanded), (_OF_SLIDE, moving)):
        stopped = inputs.columns(kind)
        for column in columns:
            if column in stopped:
                row = SIGNALS[kind.value]
                return f"{row.name(inputs.letters[column])} = {int(row.idle)}"
    return None


def induced_past_interlock(
    inputs: Inputs, pair: InclinedPair | None, commanded: Iterable[int], moving: Iterable[int], span: Span
) -> Alarm | None:
    """The note that the inclined axis moves an orthogonal one whose interlock is on: *ITx belongs to the
    commanded axis alone, so both must be interlocked (*ITx, 注意)."""
    stopped = inputs.columns(_OF_COMMAND)
    if pair is None or pair.orthogonal not in stopped or pair.inclined in stopped:
        return None
    if pair.orthogonal in set(commanded) or pair.orthogonal not in set(moving):
        return None
    letter = inputs.letters[pair.orthogonal]
    found = f"slide {letter} moves with {inputs.letters[pair.inclined]} although *IT{letter} = 0"
    return Alarm(number="HT9121", found=found, span=span)
