"""G00, G01, G04, G27, G28, G30, G31, G53 and the choice among all codes that move or set something."""

from collections.abc import Callable
from dataclasses import replace

from controller.commands import Dwell, MachineMove, ReferenceCheck, ReferenceReturn, Skip
from controller.language.cycles.peck_blocks import interpret_grooving
from controller.language.cycles.profile_blocks import (
    interpret_finishing,
    interpret_pattern,
    interpret_roughing,
)
from controller.language.cycles.single_blocks import interpret_single
from controller.language.cycles.thread_cycle_blocks import interpret_threads
from controller.language.draft import Draft
from controller.language.families.arc_blocks import arc
from controller.language.families.offset_blocks import set_coordinates, set_local_system, set_offsets
from controller.language.families.straight_blocks import G00, G01, move_of, move_of_words, straight
from controller.language.families.stroke_blocks import set_stroke_check
from controller.language.families.thread_blocks import thread
from controller.language.sync_checks import check_axes
from controller.tables.codes import Group, g_name

G02, G03, G32 = 20, 30, 320
G04, G27, G28, G30, G31, G53 = 40, 270, 280, 300, 310, 530
_REFERENCE_POINTS = (2, 3, 4)


def interpret_motion(draft: Draft) -> None:
    """The one-shot code of the block, or its axis words by the motion code in force."""
    set_stroke_check(draft)
    for code in draft.block.codes:
        if code in _ONE_SHOT:
            _ONE_SHOT[code](draft)
            return
    _MODAL[draft.modal.codes[Group.MOTION]](draft)


def _dwell(draft: Draft) -> None:
    """G04 X or U in seconds, P in milliseconds."""
    word = draft.take("X") or draft.take("U")
    if word:
        seconds = draft.reader.seconds(word)
    elif word := draft.take("P"):
        seconds = draft.reader.milliseconds(word)
    else:
        raise draft.alarm(
            "HT9012", "G04 without time", draft.code_word(G04), valid="X or U in seconds, P in ms"
        )
    draft.commands.append(Dwell(seconds=seconds))


def _skip(draft: Draft) -> None:
    """G31: a straight move at feed that the skip signal ends."""
    move = move_of_words(draft, rapid=False)
    if move is None:
        raise draft.alarm(
            "HT9012", "G31 without axis", draft.code_word(G31), valid="the axes to move, as in G31 Z"
        )
    draft.commands.append(Skip(move=move))


def _reference_return(draft: Draft) -> None:
    """G28, G30: at rapid to the intermediate point, then to the first, or the 2nd to 4th reference point."""
    code = G28 if G28 in draft.block.codes else G30
    point = 1 if code == G28 else _reference_point(draft)
    word, name = draft.code_word(code), g_name(code)
    absolute, incremental = draft.axis_words()
    words = absolute | incremental
    if not words:
        valid = f"the axes to return, as in {name} U0 W0"
        raise draft.alarm("HT9012", f"{name} without axis", word, valid=valid)
    draft.refuse_sync_axes(words, name)
    draft.check_together(words)
    for column, one in words.items():
        draft.refuse_analogue(column, one)
        turned = column in draft.motion.spindles.free
        if turned and (column in absolute or draft.axis_value(column, one) != 0.0):
            letter = draft.letter(column)
            valid = f"{name} with 0 for {letter}"
            raise draft.alarm("PS0197", f"{name} {one} after the axis has turned", one, valid=valid)
    columns = tuple(sorted(words))
    span = draft.block.place(word) if word else draft.block.span
    draft.motion.references.check_order(columns, span, point=point)
    moving = {column: one for column, one in incremental.items() if draft.axis_value(column, one) != 0.0}
    if absolute or moving:
        draft.commands.append(move_of(draft, absolute, moving, None))
    if draft.machine.work_spindle in columns:
        draft.modal = replace(draft.modal, direction=0)
    draft.commands.append(ReferenceReturn(axes=columns, span=span, point=point))


def _reference_point(draft: Draft) -> int:
    """P of G30: 2, 3 or 4; without P the second."""
    word = draft.take("P")
    point = draft.reader.natural(word) if word else 2
    if point not in _REFERENCE_POINTS:
        raise draft.alarm("PS0046", f"G30 {word}", word, valid="P2, P3 or P4")
    return point


def _reference_check(draft: Draft) -> None:
    """G27: at rapid to a position that has to be the first reference point."""
    word = draft.code_word(G27)
    absolute, incremental = draft.axis_words()
    words = absolute | incremental
    if not words:
        raise draft.alarm("HT9012", "G27 without axis", word, valid="the axes to check, as in G27 X Z")
    draft.refuse_sync_axes(words, "G27")
    check_axes(draft, absolute, incremental)
    draft.commands.append(move_of(draft, absolute, incremental, None))
    span = draft.block.place(word) if word else draft.block.span
    draft.commands.append(ReferenceCheck(axes=tuple(sorted(words)), span=span))


def _machine_move(draft: Draft) -> None:
    """G53: at rapid to machine coordinates, absolute only."""
    absolute, incremental = draft.axis_words()
    for word in incremental.values():
        raise draft.alarm("PS0009", f"{word} with G53", word, valid="absolute axis words")
    if not absolute:
        raise draft.alarm("HT9012", "G53 without axis", draft.code_word(G53), valid="absolute axis words")
    draft.refuse_sync_axes(absolute, "G53")
    check_axes(draft, absolute, {})
    draft.commands.append(
        MachineMove(
            target={column: draft.axis_value(column, word) for column, word in absolute.items()},
            places={column: word.column for column, word in absolute.items()},
        )
    )


def _end_of_data(draft: Draft) -> None:
    """G11: every G10 of this controller ends with its block, so there is nothing left to end."""


_ONE_SHOT: dict[int, Callable[[Draft], None]] = {
    G04: _dwell,
    100: set_offsets,
    110: _end_of_data,
    G27: _reference_check,
    G28: _reference_return,
    G30: _reference_return,
    G31: _skip,
    500: set_coordinates,
    520: set_local_system,
    G53: _machine_move,
    700: interpret_finishing,
    710: interpret_roughing,
    720: interpret_roughing,
    730: interpret_pattern,
    740: interpret_grooving,
    750: interpret_grooving,
    760: interpret_threads,
}
_MODAL: dict[int, Callable[[Draft], None]] = {
    G00: straight,
    G01: straight,
    G02: arc,
    G03: arc,
    G32: thread,
    900: interpret_single,
    920: interpret_single,
    940: interpret_single,
}
