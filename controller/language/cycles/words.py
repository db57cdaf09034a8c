"""What the blocks of all cycles have in common: their axes, their start, and the faults of their words."""

from dataclasses import replace

from controller.language.cycles.strokes import MOST_PASSES, PlaneAxes, Point, Stroke
from controller.language.draft import Draft
from controller.language.lexer import Word
from controller.language.sync_checks import check_axes
from controller.tables.alarms import AlarmError
from controller.tables.codes import Group

G18 = 180
_FIRST_CYCLE, _LAST_CYCLE = 700, 760


def plane_axes(draft: Draft, *words: Word | None) -> PlaneAxes:
    """The columns of Z and X, checked for motion like words that name them. PS0021 outside G18."""
    letters = draft.machine.letters
    word = next((one for one in words if one), None)
    if draft.modal.codes[Group.PLANE] != G18 or "X" not in letters or "Z" not in letters:
        raise draft.alarm("PS0021", "a turning cycle outside the Z X plane", word, valid="G18")
    axes = PlaneAxes(z=letters.index("Z"), x=letters.index("X"), places={})
    for column in (axes.z, axes.x):
        named = Word(draft.letter(column), "", word.column if word else 1)
        check_axes(draft, {}, {column: named})
    return axes


def cycle_word(draft: Draft) -> Word | None:
    """The word of the cycle's code in its block."""
    return next(
        (word for code, word in draft.block.codes.items() if _FIRST_CYCLE <= code <= _LAST_CYCLE), None
    )


def start_point(draft: Draft, axes: PlaneAxes) -> Point:
    """Where the cycle begins, and ends."""
    return draft.position(axes.z), draft.position(axes.x)


def cycle_fault(draft: Draft, word: Word | None, found: str, valid: str) -> AlarmError:
    """PS0062 at a word, or at the cycle's code."""
    return draft.alarm("PS0062", found, word or cycle_word(draft), valid=valid)


def positive(draft: Draft, word: Word, value: float) -> float:
    """The value of a word that has to be above 0: PS0062."""
    if value <= 0.0:
        raise cycle_fault(draft, word, str(word), f"{word.address} above 0")
    return value


def not_negative(draft: Draft, word: Word, value: float) -> float:
    """The value of a word that must not be below 0: PS0062."""
    if value < 0.0:
        raise cycle_fault(draft, word, str(word), f"{word.address} not below 0")
    return value


def end_point(draft: Draft) -> tuple[PlaneAxes, Point]:
    """Where the axis words of the cycle lead; an axis that is not named stays."""
    absolute, incremental = draft.axis_words()
    words = absolute | incremental
    axes = plane_axes(draft, *words.values(), cycle_word(draft))
    for column, word in words.items():
        if column not in (axes.z, axes.x):
            raise draft.alarm("PS0009", f"{word} with {cycle_word(draft)}", word, valid="X, U, Z, W")
    start = dict(zip((axes.z, axes.x), start_point(draft, axes), strict=True))
    end = dict(start)
    for column, word in words.items():
        end[column] = draft.axis_value(column, word) + (start[column] if column in incremental else 0.0)
    places = {column: word.column for column, word in words.items()}
    return replace(axes, places=places), (end[axes.z], end[axes.x])


def check_passes(draft: Draft, passes: int) -> None:
    """HT9016 before the first stroke of a cycle that would hardly end."""
    if passes > MOST_PASSES:
        raise draft.alarm("HT9016", f"{passes} passes", cycle_word(draft), valid=f"at most {MOST_PASSES}")


def swapped(point: Point) -> Point:
    """Z and X exchanged: G72 is G71, and G75 is G74, with the axes exchanged."""
    return point[1], point[0]


def swapped_stroke(stroke: Stroke) -> Stroke:
    """The same stroke with Z and X exchanged, which turns arcs round."""
    centre = None if stroke.centre is None else swapped(stroke.centre)
    return replace(stroke, end=swapped(stroke.end), centre=centre, clockwise=not stroke.clockwise)
