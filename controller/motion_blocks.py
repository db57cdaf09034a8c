"""G00, G01, G04, G28, G50, G53, feeds, work offsets and tools: what moves axes or zero points."""

from dataclasses import replace

from controller.codes import Group, g_name
from controller.commands import (
    Dwell,
    Feed,
    MachineMove,
    Move,
    ReferenceReturn,
    SelectTool,
    SetCoordinates,
    ShiftCoordinates,
)
from controller.draft import Draft
from controller.gearbox import MM_PER_INCH, SyncKind
from controller.lexer import Word
from controller.offsets import LAST_TOOL_OFFSET
from controller.registers import modulo

G00, G04, G28, G50, G53 = 0, 40, 280, 500, 530
LONGEST_MOVE = 99999.999
"""[mm | deg] PS5007 beyond"""
_TOOL_DIGITS = (3, 4)


def interpret_tool(draft: Draft) -> None:
    """T: tool and offset, T0101. The offset moves the zero point, not the axes."""
    word = draft.take("T")
    if word is None:
        return
    draft.refuse_in_sync(f"the tool change {word}", word)
    value = draft.reader.natural(word)
    if len(word.text.lstrip("+")) not in _TOOL_DIGITS:
        raise draft.alarm("HT9010", str(word), word)
    tool, offset = divmod(value, 100)
    if offset > LAST_TOOL_OFFSET:
        raise draft.alarm("PS0030", str(word), word)
    old = draft.offsets.of_tool(draft.modal.tool_offset, draft.machine)
    new = draft.offsets.of_tool(offset, draft.machine)
    _shift(draft, old, new)
    draft.modal = replace(draft.modal, tool=tool, tool_offset=offset)
    draft.commands.append(SelectTool(number=tool))


def interpret_work_offset(draft: Draft, before: int) -> None:
    """G54-G59 in place of the work offset `before`."""
    after = draft.modal.codes[Group.WORK_OFFSET]
    if after != before:
        old = draft.offsets.of_work(before, draft.machine)
        new = draft.offsets.of_work(after, draft.machine)
        _shift(draft, old, new)


def _shift(draft: Draft, old: dict[int, float], new: dict[int, float]) -> None:
    shift = {k: new.get(k, 0.0) - old.get(k, 0.0) for k in {*old, *new}}
    if any(shift.values()):
        draft.commands.append(ShiftCoordinates(shift=shift))


def interpret_feed(draft: Draft, modes_before: int) -> None:
    """F, kept for its mode: after a change between G98 and G99 an F of the new mode is due."""
    if draft.modal.codes[Group.FEED] != modes_before:
        draft.modal = replace(draft.modal, feed=None)
    if word := draft.take("F"):
        value = draft.reader.feed(word, per_revolution=draft.modal.per_revolution)
        draft.modal = replace(draft.modal, feed=value, feed_inch=draft.reader.inch)


def interpret_motion(draft: Draft) -> None:
    """The one-shot code of the block, or its axis words by the modal G00 or G01."""
    codes = draft.block.codes
    if G04 in codes:
        _dwell(draft)
    elif G28 in codes:
        _reference_return(draft)
    elif G50 in codes:
        _set_coordinates(draft)
    elif G53 in codes:
        _machine_move(draft)
    else:
        _straight(draft)


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


def _straight(draft: Draft) -> None:
    absolute, incremental = draft.axis_words()
    if not absolute and not incremental:
        return
    _check_axes(draft, absolute, incremental)
    rapid = draft.modal.codes[Group.MOTION] == G00
    feed = None if rapid else _feed(draft, [*absolute, *incremental])
    _append_move(draft, absolute, incremental, feed)


def _append_move(
    draft: Draft, absolute: dict[int, Word], incremental: dict[int, Word], feed: Feed | None
) -> None:
    words = absolute | incremental
    values = {column: draft.axis_value(column, word) for column, word in words.items()}
    for column, word in words.items():
        if abs(values[column]) > LONGEST_MOVE:
            raise draft.alarm("PS5007", str(word), word, valid=f"within {LONGEST_MOVE:g}")
    draft.commands.append(
        Move(
            absolute={column: values[column] for column in absolute},
            incremental={column: values[column] for column in incremental},
            feed=feed,
            places={column: word.column for column, word in words.items()},
        )
    )


def _feed(draft: Draft, columns: list[int]) -> Feed:
    """The feed in force, by seconds; PS0011 without one, HT9007 where it would wait for ever."""
    modal = draft.modal
    place = draft.code_word(10)
    if not modal.feed:
        found = "F0" if modal.feed is not None else f"no F since {g_name(modal.codes[Group.FEED])}"
        raise draft.alarm("PS0011", found, place)
    linear = any(not draft.machine.axes[column].rotary for column in columns)
    value = modal.feed * (MM_PER_INCH if modal.feed_inch and linear else 1.0)
    if not modal.per_revolution:
        return Feed(value=value / 60.0)
    if modal.gear:
        still, cause = modal.sync_rpm == 0.0, "S0 in sync: the work axis stands still"
    else:
        work = draft.machine.work_spindle
        turns = work is not None and draft.motion.spindles.turning(work, draft.motion.time)
        still, cause = not (modal.direction or turns), "the work spindle stands still"
    if still:
        raise draft.alarm("HT9007", f"F{modal.feed:g} by G99, {cause}", place)
    measured = modal.gear is None or not draft.machine.parameters.bit(201, 2)
    return Feed(value=value, per_revolution=True, measured=measured)


def _check_axes(draft: Draft, absolute: dict[int, Word], incremental: dict[int, Word]) -> None:
    """What sync forbids, and axes that do not know where they are."""
    motion = draft.motion
    for column, word in (absolute | incremental).items():
        _check_sync(draft, column, word, absolute=column in absolute)
        if column in motion.spindles.free or (column == draft.machine.work_spindle and _spindle_mode(draft)):
            raise draft.alarm("PS0197", f"{word} after the axis has turned as a spindle", word)
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


def _reference_return(draft: Draft) -> None:
    """G28: at rapid to the intermediate point, then to the first reference point."""
    word = draft.code_word(G28)
    absolute, incremental = draft.axis_words()
    words = absolute | incremental
    if not words:
        raise draft.alarm("HT9012", "G28 without axis", word, valid="the axes to return, as in G28 U0 W0")
    gear = draft.modal.gear
    for column, one in words.items():
        if gear and column in (gear.master, gear.slave):
            draft.refuse_in_sync(f"G28 of {one}", one)
    for column, one in words.items():
        turned = column in draft.motion.spindles.free
        if turned and (column in absolute or draft.axis_value(column, one) != 0.0):
            letter = draft.letter(column)
            raise draft.alarm(
                "PS0197", f"G28 {one} after the axis has turned", one, valid=f"G28 with 0 for {letter}"
            )
    columns = tuple(sorted(words))
    span = draft.block.place(word) if word else draft.block.span
    draft.motion.references.check_order(columns, span)
    moving = {column: one for column, one in incremental.items() if draft.axis_value(column, one) != 0.0}
    if absolute or moving:
        _append_move(draft, absolute, moving, None)
    if draft.machine.work_spindle in columns:
        draft.modal = replace(draft.modal, direction=0)
    draft.commands.append(ReferenceReturn(axes=columns, span=span))


def _set_coordinates(draft: Draft) -> None:
    """G50 X Z …: the present position gets these absolute coordinates; increments change them by so much."""
    absolute, incremental = draft.axis_words()
    if not absolute and not incremental:
        if "S" not in draft.block.words:
            raise draft.alarm(
                "HT9012", "G50 without S or axis", draft.code_word(G50), valid="G50 S or G50 X Z"
            )
        return
    target: dict[int, float] = {}
    for column, word in (absolute | incremental).items():
        gear = draft.modal.gear
        if gear and column in (gear.master, gear.slave):
            draft.refuse_in_sync(f"G50 of {word}", word)
        value = draft.axis_value(column, word)
        if column in incremental:
            value += float(draft.motion.registers.absolute[column])
        target[column] = modulo(value) if draft.machine.axes[column].type_a else value
    draft.commands.append(SetCoordinates(absolute=target))


def _machine_move(draft: Draft) -> None:
    """G53: at rapid to machine coordinates, absolute only."""
    absolute, incremental = draft.axis_words()
    for word in incremental.values():
        raise draft.alarm("PS0009", f"{word} with G53", word, valid="absolute axis words")
    if not absolute:
        raise draft.alarm("HT9012", "G53 without axis", draft.code_word(G53), valid="absolute axis words")
    gear = draft.modal.gear
    for column, word in absolute.items():
        if gear and column in (gear.master, gear.slave):
            draft.refuse_in_sync(f"G53 of {word}", word)
    _check_axes(draft, absolute, {})
    draft.commands.append(
        MachineMove(
            target={column: draft.axis_value(column, word) for column, word in absolute.items()},
            places={column: word.column for column, word in absolute.items()},
        )
    )
