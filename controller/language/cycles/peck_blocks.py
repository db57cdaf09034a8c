"""G74, G75: the words of the pecking cycles."""

from dataclasses import replace

from controller.language.cycles.grooving import Grooving, grooves_needed, peck, pecks_needed
from controller.language.cycles.profile import NOTHING
from controller.language.cycles.strokes import commands_of
from controller.language.cycles.words import (
    check_passes,
    cycle_fault,
    end_point,
    not_negative,
    positive,
    start_point,
    swapped,
    swapped_stroke,
)
from controller.language.draft import Draft
from controller.language.families.feed_blocks import feed_in_force

G74 = 740


def interpret_grooving(draft: Draft) -> None:
    """G74 R, G75 R; then X(U) Z(W) P Q R F: P always along X, in radius, Q along Z."""
    along_z = G74 in draft.block.codes
    name = "G74" if along_z else "G75"
    if draft.rest.keys() <= {"R"}:
        word = draft.take("R")
        if word is None:
            raise cycle_fault(draft, None, f"{name} without words", "R for the retraction, or X Z P Q R F")
        retract = not_negative(draft, word, draft.reader.length(word))
        draft.modal = replace(draft.modal, cycles=replace(draft.modal.cycles, peck_return=retract))
        return
    axes, end = end_point(draft)
    start = start_point(draft, axes)
    amounts = {address: draft.take(address) for address in "PQ"}
    relief_word = draft.take("R")
    steps = {
        address: positive(draft, word, draft.reader.counted_length(word)) if word else 0.0
        for address, word in amounts.items()
    }
    if draft.modal.cycles.peck_return is None:
        raise cycle_fault(draft, None, "no retraction yet", f"{name} R__ before this block")
    for address, way in (("P", end[1] - start[1]), ("Q", end[0] - start[0])):
        if abs(way) > NOTHING and steps[address] == 0.0:
            raise cycle_fault(
                draft, None, f"{name} without {address}", f"{address}, in 0.001 mm or with a point"
            )
    data = Grooving(
        start=start if along_z else swapped(start),
        end=end if along_z else swapped(end),
        peck=(steps["Q"] if along_z else steps["P"]) or 1.0,
        shift=(steps["P"] if along_z else steps["Q"]) or 1.0,
        retract=draft.modal.cycles.peck_return,
        relief=draft.reader.length(relief_word) if relief_word else 0.0,
    )
    if relief_word and data.relief < 0.0 and grooves_needed(data) > 1:
        raise cycle_fault(
            draft, relief_word, str(relief_word), "R not below 0 where P and Q decide its direction"
        )
    check_passes(draft, grooves_needed(data) * pecks_needed(data))
    strokes = peck(data)
    if not along_z:
        strokes = (swapped_stroke(stroke) for stroke in strokes)
    feed = feed_in_force(draft, (axes.z, axes.x))
    draft.sequel = commands_of(strokes, start, axes, feed)
