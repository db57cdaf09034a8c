"""G32: a straight thread cut, bound to the angle of the work spindle."""

from controller.commands import Thread
from controller.language.draft import Draft
from controller.language.families.feed_blocks import check_encoder, check_turning, lead_in_force
from controller.language.sync_checks import check_axes
from controller.motion.registers import TURN


def thread(draft: Draft) -> None:
    """G32 X Z F Q: F the lead along the axis that travels further, Q the angle at which the cut begins."""
    angle = start_angle(draft)
    absolute, incremental = draft.axis_words()
    if not absolute and not incremental:
        return
    check_thread(draft)
    check_axes(draft, absolute, incremental)
    words = absolute | incremental
    draft.commands.append(
        Thread(
            absolute={column: draft.axis_value(column, word) for column, word in absolute.items()},
            incremental={column: draft.axis_value(column, word) for column, word in incremental.items()},
            lead=lead_in_force(draft),
            start_angle=angle,
            places={column: word.column for column, word in words.items()},
        )
    )


def start_angle(draft: Draft) -> float:
    """Q [deg], 0 without it."""
    word = draft.take("Q")
    if word is None:
        return 0.0
    angle = draft.reader.counted_angle(word)
    if not 0.0 <= angle <= TURN:
        raise draft.alarm(
            "HT9012", str(word), word, valid="Q0 to Q360000, in 0.001 deg, or degrees with a point"
        )
    return angle


def check_thread(draft: Draft) -> None:
    """A thread needs a turning work spindle that belongs to it alone: HT9007, in sync PS1595 or PS0220."""
    draft.refuse_in_sync("thread cutting")
    check_turning(draft, "a thread")
    check_encoder(draft, "a thread")
