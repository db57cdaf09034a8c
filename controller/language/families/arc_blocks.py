"""G02, G03: circular arcs in G17, G18, G19 by the centre (I J K) or by the radius (R)."""

import math

from controller.commands import Arc
from controller.language.draft import Draft
from controller.language.families.feed_blocks import feed_in_force
from controller.language.lexer import Word
from controller.language.sync_checks import check_axes
from controller.laws.arcs import NOTHING, Point, centre_from_offsets, centre_from_radius
from controller.tables.codes import Group, g_name

G02, G17, G18, G19 = 20, 170, 180, 190
_BASIC = {G17: ("X", "Y"), G18: ("Z", "X"), G19: ("Y", "Z")}
"""plane -> first and second basic axis, right-handed"""
_CENTRE_LETTER = {"X": "I", "Y": "J", "Z": "K"}


def arc(draft: Draft) -> None:
    """One arc; axes outside the plane go along. PS0020, PS0021, PS0022."""
    if not draft.rest:
        return
    plane, letters = _plane(draft)
    centre_words = [draft.take(_CENTRE_LETTER[letter]) for letter in letters]
    radius_word = draft.take("R")
    absolute, incremental = draft.axis_words()
    words = absolute | incremental
    given = [word for word in (*centre_words, radius_word) if word]
    if not words and not given:
        return
    motion_code = draft.modal.codes[Group.MOTION]
    name, place = g_name(motion_code), draft.code_word(motion_code)
    if not given:
        valid = f"R, or {' '.join(_CENTRE_LETTER[letter] for letter in letters)} for the centre"
        raise draft.alarm(
            "PS0022", f"{name} without a circle", place or next(iter(words.values())), valid=valid
        )
    check_axes(draft, absolute, incremental)
    targets = {column: draft.axis_value(column, word) for column, word in words.items()}
    end = tuple(
        0.0
        if column not in targets
        else targets[column] - (0.0 if column in incremental else draft.position(column))
        for column in plane
    )
    clockwise = motion_code == G02
    if radius_word:
        centre = _by_radius(draft, (end[0], end[1]), radius_word, centre_words, clockwise=clockwise)
    else:
        centre = _by_centre(draft, (end[0], end[1]), centre_words)
    draft.commands.append(
        Arc(
            absolute={column: targets[column] for column in absolute},
            incremental={column: targets[column] for column in incremental},
            plane=plane,
            centre=centre,
            clockwise=clockwise,
            feed=feed_in_force(draft, (*plane, *words)),
            places={column: word.column for column, word in words.items()},
        )
    )


def _plane(draft: Draft) -> tuple[tuple[int, int], tuple[str, str]]:
    """Columns and basic letters of the plane in force; PS0021 where the machine has no such plane."""
    code = draft.modal.codes[Group.PLANE]
    letters = _BASIC[code]
    columns: list[int] = []
    for letter in letters:
        column = draft.machine.basic.get(letter)
        if column is None:
            place = draft.code_word(code) or draft.code_word(draft.modal.codes[Group.MOTION])
            raise draft.alarm("PS0021", f"an arc in {g_name(code)} without linear axis {letter}", place)
        columns.append(column)
    return (columns[0], columns[1]), letters


def _by_radius(
    draft: Draft, end: Point, word: Word, centre_words: list[Word | None], *, clockwise: bool
) -> Point:
    for one in centre_words:
        if one:
            raise draft.alarm("PS0022", f"{one} beside {word}", one, valid="either R or I J K")
    radius = draft.reader.length(word)
    centre = centre_from_radius(end, radius, clockwise=clockwise, tolerance=_tolerance(draft))
    if centre is None:
        chord = math.hypot(*end)
        valid = f"a radius of at least {chord / 2.0:.3f} mm"
        if chord < NOTHING or radius == 0.0:
            valid = "an end away from the start; I and K for a full circle"
        raise draft.alarm("PS0020", f"{word} over a chord of {chord:.3f} mm", word, valid=valid)
    return centre


def _by_centre(draft: Draft, end: Point, words: list[Word | None]) -> Point:
    first, second = (draft.reader.length(word) if word else 0.0 for word in words)
    centre = centre_from_offsets((first, second), end, tolerance=_tolerance(draft))
    if centre is None:
        word = next(word for word in words if word)
        start_radius = math.hypot(first, second)
        if start_radius == 0.0:
            valid = "I J K from the start point to the centre"
            raise draft.alarm("PS0022", "a radius of 0", word, valid=valid)
        end_radius = math.hypot(end[0] - first, end[1] - second)
        found = f"a radius of {start_radius:.3f} mm at the start, {end_radius:.3f} at the end"
        raise draft.alarm("PS0020", found, word, valid=f"within {_tolerance(draft):g} mm (parameter 3410)")
    return centre


def _tolerance(draft: Draft) -> float:
    return draft.machine.parameters.number(3410)
