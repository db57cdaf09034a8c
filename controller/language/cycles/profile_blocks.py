"""G70 to G73: the words of the cycles that follow a profile."""

from dataclasses import replace
from functools import partial

from controller.language.cycles.pattern import Pattern, repeat
from controller.language.cycles.profile import NOTHING, Piece, profile_lines, read_profile
from controller.language.cycles.roughing import Roughing, monotonous, passes_needed, remove
from controller.language.cycles.strokes import PlaneAxes, Point, commands_of
from controller.language.cycles.words import (
    check_passes,
    cycle_fault,
    cycle_word,
    not_negative,
    plane_axes,
    positive,
    start_point,
    swapped,
    swapped_stroke,
)
from controller.language.draft import Draft
from controller.language.families.feed_blocks import feed_in_force
from controller.tables.alarms import alarm

G70, G71 = 700, 710


def interpret_finishing(draft: Draft) -> None:
    """G70 P Q: the blocks of the profile themselves, with their F and S, and back to the start point."""
    axes = plane_axes(draft, draft.code_word(G70))
    first, last = profile_lines(draft)
    read_profile(draft, first, last, (axes.z, axes.x))
    start = start_point(draft, axes)
    home = {axes.x: start[1], axes.z: start[0]}
    draft.go = partial(draft.flow.enter_profile, first, last, back=draft.index + 1, home=home)


def interpret_roughing(draft: Draft) -> None:
    """G71 U R and G71 P Q U W; G72 W R and G72 P Q U W."""
    along_z = G71 in draft.block.codes
    if not {"P", "Q"} & draft.rest.keys():
        _set_depth(draft, "U" if along_z else "W")
        return
    axes = plane_axes(draft, cycle_word(draft))
    allowance = _allowance(draft, axes)
    first, last = profile_lines(draft)
    feed = feed_in_force(draft, (axes.z, axes.x))
    pieces = read_profile(draft, first, last, (axes.z, axes.x))
    if not along_z:
        pieces, allowance = [piece.swapped() for piece in pieces], swapped(allowance)
    _check_shape(draft, pieces, along_z=along_z)
    cycles = draft.modal.cycles
    if cycles.depth is None or cycles.escape is None:
        first_form = "G71 U__ R__" if along_z else "G72 W__ R__"
        raise cycle_fault(draft, None, "no depth of cut yet", f"{first_form} before this block")
    data = Roughing(depth=cycles.depth, escape=cycles.escape, allowance=allowance)
    check_passes(draft, passes_needed(pieces, data))
    strokes = remove(pieces, data)
    if not along_z:
        strokes = (swapped_stroke(stroke) for stroke in strokes)
    draft.sequel = commands_of(strokes, start_point(draft, axes), axes, feed)
    _go_behind(draft, first, last)


def _set_depth(draft: Draft, address: str) -> None:
    """The first block: depth of cut (in radius) and escape."""
    depth, escape = draft.take(address), draft.take("R")
    if depth is None and escape is None:
        valid = f"{address} and R for the depth of cut, or P and Q for the profile"
        raise draft.alarm("PS0061", f"{cycle_word(draft)} without P and Q", cycle_word(draft), valid=valid)
    cycles = draft.modal.cycles
    if depth:
        cycles = replace(cycles, depth=positive(draft, depth, draft.reader.length(depth)))
    if escape:
        cycles = replace(cycles, escape=not_negative(draft, escape, draft.reader.length(escape)))
    draft.modal = replace(draft.modal, cycles=cycles)


def _allowance(draft: Draft, axes: PlaneAxes) -> Point:
    """U and W of the second block."""
    u, w = draft.take("U"), draft.take("W")
    return (draft.axis_value(axes.z, w) if w else 0.0, draft.axis_value(axes.x, u) if u else 0.0)


def _check_shape(draft: Draft, pieces: list[Piece], *, along_z: bool) -> None:
    """PS0065 for the infeed, PS0064 for a profile that turns back."""
    infeed = pieces[0]
    straight_in = infeed.centre is None and abs(infeed.end[0] - infeed.start[0]) < NOTHING
    if not straight_in or abs(infeed.end[1] - infeed.start[1]) < NOTHING or len(pieces) < 2:
        axis = "X" if along_z else "Z"
        place = draft.flow.program.span(infeed.line, 1)
        raise alarm("PS0065", f"a profile that does not begin with an infeed along {axis}", place)
    line = monotonous(pieces)
    if line is not None:
        place = draft.flow.program.span(line, 1)
        raise alarm("PS0064", "a profile that turns back in X or in Z", place)


def _go_behind(draft: Draft, first: int, last: int) -> None:
    """The profile is not run a second time where it follows the cycle's block at once."""
    between = range(draft.index + 1, first)
    if draft.index < first and all(draft.block_at(line).empty for line in between):
        draft.go = partial(draft.flow.go_to, last + 1)


def interpret_pattern(draft: Draft) -> None:
    """G73 U W R and G73 P Q U W."""
    axes = plane_axes(draft, cycle_word(draft))
    if not {"P", "Q"} & draft.rest.keys():
        _set_relief(draft)
        return
    allowance = _allowance(draft, axes)
    first, last = profile_lines(draft)
    feed = feed_in_force(draft, (axes.z, axes.x))
    pieces = read_profile(draft, first, last, (axes.z, axes.x))
    cycles = draft.modal.cycles
    if cycles.relief is None or cycles.divisions is None:
        raise cycle_fault(draft, None, "no number of passes yet", "G73 U__ W__ R__ before this block")
    data = Pattern(relief=cycles.relief, divisions=cycles.divisions, allowance=allowance)
    draft.sequel = commands_of(repeat(pieces, data), start_point(draft, axes), axes, feed)
    _go_behind(draft, first, last)


def _set_relief(draft: Draft) -> None:
    """The first block: way from the last to the first pass (X in radius), number of passes."""
    u, w, r = draft.take("U"), draft.take("W"), draft.take("R")
    if r is None:
        valid = "U, W and R for the passes, or P and Q for the profile"
        raise draft.alarm("PS0061", "G73 without P and Q", cycle_word(draft), valid=valid)
    divisions = draft.reader.whole(r)
    positive(draft, r, divisions)
    check_passes(draft, divisions)
    relief = (draft.reader.length(w) if w else 0.0, draft.reader.length(u) if u else 0.0)
    cycles = replace(draft.modal.cycles, relief=relief, divisions=divisions)
    draft.modal = replace(draft.modal, cycles=cycles)
