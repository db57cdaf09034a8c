"""G76: the words of the threading cycle."""

from dataclasses import replace

from controller.language.cycles.strokes import MOST_PASSES, commands_of
from controller.language.cycles.threads import ANGLES, Threading, cut_thread, depths
from controller.language.cycles.words import cycle_fault, end_point, not_negative, positive, start_point
from controller.language.draft import Draft
from controller.language.families.feed_blocks import lead_in_force
from controller.language.families.thread_blocks import check_thread
from controller.language.lexer import Word

_TENTH = 0.1


def interpret_threads(draft: Draft) -> None:
    """G76 P(m r a) Q R, then G76 X(U) Z(W) R P Q F."""
    if not {"X", "U", "Z", "W"} & draft.rest.keys():
        _set_thread_data(draft)
        return
    axes, end = end_point(draft)
    start = start_point(draft, axes)
    height_word, depth_word, taper_word = draft.take("P"), draft.take("Q"), draft.take("R")
    if height_word is None or depth_word is None:
        missing = "P" if height_word is None else "Q"
        raise cycle_fault(
            draft, None, f"G76 without {missing}", "P the height, Q the first depth, in 0.001 mm"
        )
    check_thread(draft)
    cycles = draft.modal.cycles
    if cycles.spring_passes is None or cycles.smallest_depth is None or cycles.allowance is None:
        raise cycle_fault(draft, None, "no passes yet", "G76 P(m r a) Q R before this block")
    lead = lead_in_force(draft)
    data = Threading(
        start=start,
        end=end,
        taper=draft.reader.length(taper_word) if taper_word else 0.0,
        height=positive(draft, height_word, draft.reader.counted_length(height_word)),
        first_depth=positive(draft, depth_word, draft.reader.counted_length(depth_word)),
        smallest_depth=cycles.smallest_depth,
        allowance=cycles.allowance,
        spring_passes=cycles.spring_passes,
        chamfer=(cycles.chamfer or 0.0) * lead,
        tip_angle=cycles.thread_angle or 0.0,
        lead=lead,
        start_angle=0.0,
    )
    _check_thread_data(draft, data, height_word, depth_word)
    passes = depths(data)
    if passes is None:
        raise draft.alarm("HT9016", f"more than {MOST_PASSES} passes", depth_word, valid="a larger Q")
    draft.sequel = commands_of(cut_thread(data, passes), start, axes, None)


def _check_thread_data(draft: Draft, data: Threading, height: Word, depth: Word) -> None:
    if data.first_depth > data.height:
        raise cycle_fault(
            draft, depth, f"{depth} above the height {height}", "a first depth within the height"
        )
    if data.allowance >= data.height or data.smallest_depth > data.height:
        found = f"R {data.allowance:g} and Q {data.smallest_depth:g} mm of the first block over {height}"
        raise cycle_fault(draft, height, found, "an allowance and a smallest depth below the height")
    flank = data.height * abs(data.end[0] - data.start[0])
    if flank == 0.0 or abs(data.end[1] - data.start[1]) <= data.height:
        raise cycle_fault(
            draft, None, "no room for the thread", "a start point outside the thread in X and in Z"
        )


def _set_thread_data(draft: Draft) -> None:
    """The first block: P two digits each for finishing passes, run-out in 0.1 leads, tip angle; Q; R."""
    word, smallest, allowance = draft.take("P"), draft.take("Q"), draft.take("R")
    cycles = draft.modal.cycles
    if word:
        passes, rest = divmod(draft.reader.natural(word), 10_000)
        chamfer, angle = divmod(rest, 100)
        if not 1 <= passes <= 99 or angle not in ANGLES:
            valid = "P with 01 to 99 passes, 00 to 99 for the run-out, and " + ", ".join(map(str, ANGLES))
            raise cycle_fault(draft, word, str(word), valid)
        cycles = replace(cycles, spring_passes=passes, chamfer=chamfer * _TENTH, thread_angle=float(angle))
    if smallest:
        value = not_negative(draft, smallest, draft.reader.counted_length(smallest))
        cycles = replace(cycles, smallest_depth=value)
    if allowance:
        value = not_negative(draft, allowance, draft.reader.length(allowance))
        cycles = replace(cycles, allowance=value)
    if not (word or smallest or allowance):
        raise cycle_fault(draft, None, "G76 without words", "P Q R, then X Z R P Q F")
    draft.modal = replace(draft.modal, cycles=cycles)
