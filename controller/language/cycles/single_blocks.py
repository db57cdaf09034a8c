"""G90, G92, G94: the words of a single cycle, which stay in force until another code of group 01."""

from dataclasses import replace

from controller.language.cycles.single import facing, threading, turning
from controller.language.cycles.strokes import commands_of
from controller.language.cycles.words import plane_axes, start_point
from controller.language.draft import Draft
from controller.language.families.feed_blocks import feed_in_force, lead_in_force
from controller.language.families.thread_blocks import check_thread, start_angle
from controller.language.modal import SingleCycle
from controller.tables.codes import Group, g_name

G90, G92 = 900, 920


def interpret_single(draft: Draft) -> None:
    """G90, G92, G94 X(U) Z(W) R: one cut, repeated with every block that names X, Z or R again."""
    code = draft.modal.codes[Group.MOTION]
    if draft.code_word(code):
        draft.modal = replace(draft.modal, single=SingleCycle())
    taper_word = draft.take("R")
    angle = start_angle(draft) if code == G92 else 0.0
    absolute, incremental = draft.axis_words()
    words = absolute | incremental
    if not words and taper_word is None:
        return
    place = draft.code_word(code) or taper_word or next(iter(words.values()))
    axes = replace(plane_axes(draft, place), places={column: word.column for column, word in words.items()})
    for column, word in words.items():
        if column not in (axes.z, axes.x):
            raise draft.alarm("PS0009", f"{word} with {g_name(code)}", word, valid="X, U, Z, W, R, F")
    end = {column: (draft.axis_value(column, word), column in incremental) for column, word in words.items()}
    taper = draft.modal.single.taper if taper_word is None else draft.reader.length(taper_word)
    single = SingleCycle(end={**draft.modal.single.end, **end}, taper=taper)
    draft.modal = replace(draft.modal, single=single)
    if len(single.end) < 2:
        raise draft.alarm("HT9012", f"{g_name(code)} without both X and Z", place, valid="X or U, and Z or W")
    start = start_point(draft, axes)
    target = (_target(single, axes.z, start[0]), _target(single, axes.x, start[1]))
    feed = None
    if code == G92:
        check_thread(draft)
        strokes = threading(start, target, taper, lead_in_force(draft), angle)
    else:
        feed = feed_in_force(draft, (axes.z, axes.x))
        strokes = (turning if code == G90 else facing)(start, target, taper)
    draft.commands.extend(command for _, command in commands_of(strokes, start, axes, feed))


def _target(single: SingleCycle, column: int, start: float) -> float:
    value, increment = single.end[column]
    return start + value if increment else value
