"""T, G10, G50, G52, G54-G59: what moves zero points, and the one move that comes of it."""

from collections.abc import Mapping
from dataclasses import replace

from controller.commands import Command, Move, SelectTool, SetCoordinates, ShiftCoordinates
from controller.language.draft import Draft
from controller.language.families.feed_blocks import feed_in_force
from controller.language.families.table_blocks import OFF, ON, TABLE, set_table
from controller.language.lexer import Word
from controller.language.offsets import LAST_TOOL_OFFSET
from controller.motion.registers import modulo
from controller.tables.codes import G_CODES, Group

G00, G10, G50, G52 = 0, 100, 500, 520
_TOOL_DIGITS = (3, 4)
_GEOMETRY = 10_000
"""P of G10 for the geometry of a tool offset"""
_WORK_OFFSET_LIST = 2
_WORK_CODES = tuple(code.tenths for code in G_CODES.values() if code.group is Group.WORK_OFFSET)
_TIPS = 9


def shift_between(old: Mapping[int, float], new: Mapping[int, float]) -> tuple[Command, ...]:
    """The command that puts a new offset, by column, in place of an old one; none where they are equal."""
    shift = {k: new.get(k, 0.0) - old.get(k, 0.0) for k in {**old, **new}}
    return (ShiftCoordinates(shift=shift),) if any(shift.values()) else ()


def interpret_tool(draft: Draft) -> None:
    """T: tool and offset, T0101. The offset moves the zero point; `move_by_offset` follows it."""
    word = draft.take("T")
    if word is None:
        return
    draft.refuse_in_sync(f"the tool change {word}", word)
    value = draft.reader.natural(word)
    digits = len(word.text.lstrip("+")) if word.value is None else len(f"{value:03d}")
    if digits not in _TOOL_DIGITS:
        raise draft.alarm("HT9010", str(word), word)
    tool, offset = divmod(value, 100)
    new = draft.offsets.of_tool(offset, draft.machine)
    draft.commands.extend(shift_between(draft.modal.tool_shift, new))
    draft.modal = replace(draft.modal, tool=tool, tool_offset=offset, tool_shift=new)
    draft.commands.append(SelectTool(number=tool))


def move_by_offset(draft: Draft) -> None:
    """The move that a T causes: by the change of what parameter 5002 lets the axes follow.

    At rapid under G00, else at the feed in force. With LWM, 5002#6 = 1, there is none: the next absolute
    words take the offset along. Fanuc 5002.
    """
    if draft.modal.tool_offset is None or draft.machine.parameters.bit(5002, 6):
        return
    old, new = draft.modal.tool_moved, draft.offsets.moving_part(draft.modal.tool_offset, draft.machine)
    change = {k: new.get(k, 0.0) - old.get(k, 0.0) for k in {**old, **new}}
    travel = {k: value for k, value in change.items() if value}
    draft.modal = replace(draft.modal, tool_moved=new)
    if travel:
        rapid = draft.modal.codes[Group.MOTION] == G00
        feed = None if rapid else feed_in_force(draft, travel)
        draft.commands.append(Move(absolute={}, incremental=travel, feed=feed, places={}))


def interpret_work_offset(draft: Draft, before: int) -> None:
    """G54-G59 in place of the work offset `before`."""
    after = draft.modal.codes[Group.WORK_OFFSET]
    if after != before:
        old = draft.offsets.of_work(before, draft.machine)
        new = draft.offsets.of_work(after, draft.machine)
        draft.commands.extend(shift_between(old, new))


def set_offsets(draft: Draft) -> None:
    """G10: P with tool offsets, L2 P with work offsets, L60 to L62 a table against the work angle. A tool
    offset counts from the next T on."""
    word, kind = draft.take("P"), draft.take("L")
    if kind is not None and draft.reader.natural(kind) in (TABLE, ON, OFF):
        set_table(draft, draft.reader.natural(kind), word)
        return
    if word is None:
        valid = "P, the number of the offset"
        raise draft.alarm("PS0030", "G10 without P", draft.code_word(G10), valid=valid)
    if kind is not None and draft.reader.natural(kind) != _WORK_OFFSET_LIST:
        valid = "L2 for work offsets, no L for tool offsets, L60 to L62 for the table of the work angle"
        raise draft.alarm("HT9003", f"G10 {kind}", kind, valid=valid)
    number = draft.reader.natural(word)
    if kind is not None:
        _set_work_offset(draft, number, word)
    else:
        _set_tool_offset(draft, number, word)


def _set_work_offset(draft: Draft, number: int, word: Word) -> None:
    """G10 L2: P1 is G54, P6 is G59. The one in force moves the zero point at once."""
    if not 1 <= number <= len(_WORK_CODES):
        raise draft.alarm("PS0030", str(word), word, valid="P1 for G54 to P6 for G59")
    tenths = _WORK_CODES[number - 1]
    old = draft.offsets.of_work(tenths, draft.machine)
    absolute, incremental = draft.axis_words()
    if not absolute and not incremental:
        raise draft.alarm(
            "HT9012", "G10 L2 without axis", draft.code_word(G10), valid="X, Z … of the zero point"
        )
    for column, axis_word in (absolute | incremental).items():
        factor = draft.machine.axes[column].factor
        value = draft.axis_value(column, axis_word) + (old.get(column, 0.0) if column in incremental else 0.0)
        draft.offsets = draft.offsets.with_work(tenths, draft.letter(column), value * factor)
    if draft.modal.codes[Group.WORK_OFFSET] == tenths:
        draft.commands.extend(shift_between(old, draft.offsets.of_work(tenths, draft.machine)))


def _set_tool_offset(draft: Draft, number: int, word: Word) -> None:
    """G10 P: 1 to 99 the wear, 10001 to 10099 the geometry; X Z Y C set, U W V H add, R and Q the nose."""
    geometry = number > _GEOMETRY
    offset = number - _GEOMETRY if geometry else number
    if not 1 <= offset <= LAST_TOOL_OFFSET:
        last = LAST_TOOL_OFFSET
        valid = f"P1 to P{last} for wear, P{_GEOMETRY + 1} to P{_GEOMETRY + last} for geometry"
        raise draft.alarm("PS0030", str(word), word, valid=valid)
    table = draft.offsets.tool if geometry else draft.offsets.wear
    old = table.get(offset, {})
    absolute, incremental = draft.axis_words()
    radius, tip = draft.take("R"), draft.take("Q")
    if not absolute and not incremental and radius is None and tip is None:
        raise draft.alarm("HT9012", "G10 without a value", draft.code_word(G10), valid="X, Z, U, W, R or Q")
    for column, axis_word in (absolute | incremental).items():
        letter, factor = draft.letter(column), draft.machine.axes[column].factor
        value = draft.axis_value(column, axis_word) * factor
        if column in incremental:
            value += old.get(letter, 0.0)
        change = draft.offsets.with_geometry if geometry else draft.offsets.with_wear
        draft.offsets = change(offset, letter, value)
    if radius is not None:
        draft.offsets = draft.offsets.with_nose(offset, "R", draft.reader.length(radius))
    if tip is not None:
        direction = draft.reader.natural(tip)
        if direction > _TIPS:
            raise draft.alarm("HT9012", str(tip), tip, valid="tip directions 0 to 9")
        draft.offsets = draft.offsets.with_nose(offset, "Q", float(direction))


def set_coordinates(draft: Draft) -> None:
    """G50 X Z …: the present position gets these absolute coordinates; increments change them by so much.

    A local coordinate system of G52 ends with it, for the axes commanded.
    """
    absolute, incremental = draft.axis_words()
    if not absolute and not incremental:
        if "S" not in draft.block.words:
            raise draft.alarm(
                "HT9012", "G50 without S or axis", draft.code_word(G50), valid="G50 S or G50 X Z"
            )
        return
    draft.refuse_sync_axes(absolute | incremental, "G50")
    target: dict[int, float] = {}
    for column, word in (absolute | incremental).items():
        value = draft.axis_value(column, word) + (draft.position(column) if column in incremental else 0.0)
        target[column] = modulo(value) if draft.machine.axes[column].type_a else value
    local = {k: v for k, v in draft.modal.local_shift.items() if k not in target}
    draft.modal = replace(draft.modal, local_shift=local)
    draft.commands.append(SetCoordinates(absolute=target))


def set_local_system(draft: Draft) -> None:
    """G52 X Z …: zero point of a local system, in work coordinates; G52 X0 Z0 cancels it."""
    absolute, incremental = draft.axis_words()
    for word in incremental.values():
        raise draft.alarm("PS0009", f"{word} with G52", word, valid="absolute axis words")
    if not absolute:
        raise draft.alarm(
            "HT9012", "G52 without axis", draft.code_word(G52), valid="X, Z … of the local zero"
        )
    draft.refuse_sync_axes(absolute, "G52")
    old = draft.modal.local_shift
    new = {**old, **{column: draft.axis_value(column, word) for column, word in absolute.items()}}
    draft.modal = replace(draft.modal, local_shift=new)
    draft.commands.extend(shift_between(old, new))
