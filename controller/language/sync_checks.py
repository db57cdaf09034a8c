"""Which axes a motion block may command: what sync forbids, spindles, axes without reference point."""

from collections.abc import Mapping

from controller.language.draft import Draft
from controller.language.families.sync_blocks import orientation
from controller.language.lexer import Word
from controller.laws.gearbox import SyncKind


def check_axes(draft: Draft, absolute: Mapping[int, Word], incremental: Mapping[int, Word]) -> None:
    """PS0015 for too many axes, PS1595 and PS0220 in sync, PS0197 for a spindle, PS0224 for an axis that does
    not know where it is."""
    motion, words = draft.motion, {**absolute, **incremental}
    draft.check_together(words)
    for column, word in words.items():
        _check_sync(draft, column, word, absolute=column in absolute)
        if column in motion.spindles.free or (column == draft.machine.work_spindle and _spindle_mode(draft)):
            found = f"{word} after the axis has turned as a spindle"
            raise draft.alarm("PS0197", found, word, valid=orientation(draft, column))
        motion.references.require(column, draft.letter(column), draft.block.place(word))


def _spindle_mode(draft: Draft) -> bool:
    """Whether M03 or M04 of this very block turns the work spindle."""
    return draft.modal.gear is None and draft.modal.direction != 0


def _check_sync(draft: Draft, column: int, word: Word, *, absolute: bool) -> None:
    """Hobbing: no master, the slave incrementally only when helical. Polygon: neither."""
    gear = draft.modal.gear
    if gear is None:
        return
    if column == gear.master:
        draft.refuse_in_sync(
            f"{word}, the master axis,", word, valid="S for its speed, or axes out of the gear box"
        )
    if column == gear.slave and gear.kind is SyncKind.POLYGON:
        draft.refuse_in_sync(
            f"{word}, the slave axis,", word, valid="S for its speed, or axes out of the gear box"
        )
    if column == gear.slave and absolute and gear.helical:
        draft.refuse_in_sync(
            f"{word}, the slave axis absolutely with helical compensation,", word, valid="its increment"
        )
