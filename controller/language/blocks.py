"""One block from its words to its commands: the order in which the parts of a block are read."""

from controller.commands import Coolant, ProgramEnd, ProgramStop
from controller.language.draft import Draft
from controller.language.families.call_blocks import (
    interpret_macro_call,
    interpret_modal_call,
    interpret_subprogram,
)
from controller.language.families.feed_blocks import interpret_feed
from controller.language.families.motion_blocks import interpret_motion
from controller.language.families.offset_blocks import (
    interpret_tool,
    interpret_work_offset,
    move_by_offset,
)
from controller.language.families.spindle_blocks import interpret_spindle, stop_spindle
from controller.language.families.sync_blocks import interpret_sync
from controller.tables.codes import G_CODES, Group

_G20, _G21 = 200, 210


def interpret_block(draft: Draft, *, optional_stop: bool) -> None:
    """Read all words of a block into commands, the modal state and the way on. Raises AlarmError."""
    before = draft.modal
    if not interpret_sync(draft) and not interpret_macro_call(draft):
        _set_codes(draft)
        interpret_tool(draft)
        interpret_work_offset(draft, before.codes[Group.WORK_OFFSET])
        interpret_spindle(draft)
        interpret_feed(draft, before.codes[Group.FEED])
        if "T" in draft.block.words:
            move_by_offset(draft)
        interpret_subprogram(draft)
        interpret_motion(draft)
        _finish_block(draft, optional_stop=optional_stop)
        interpret_modal_call(draft)
    draft.refuse_rest()


def _set_codes(draft: Draft) -> None:
    for tenths, word in draft.block.codes.items():
        if tenths in (_G20, _G21):
            draft.refuse_in_sync(str(word), word)
        if G_CODES[tenths].group is not Group.ONE_SHOT:
            draft.set_code(G_CODES[tenths].group, tenths)


def _finish_block(draft: Draft, *, optional_stop: bool) -> None:
    """The M codes that act after the motion, and coolant."""
    number = draft.block.m_code.number if draft.block.m_code else None
    if number is None:
        return
    draft.remember_m_code(number)
    if number == 0 or (number == 1 and optional_stop):
        draft.commands.append(ProgramStop(span=draft.block.span))
    elif number in (2, 30):
        draft.refuse_in_sync(f"M{number:02d}", draft.block.m_word)
        draft.commands.append(ProgramEnd())
        draft.go = draft.flow.finish
    elif number == 5:
        stop_spindle(draft)
    elif number in (8, 9):
        draft.commands.append(Coolant(on=number == 8))
