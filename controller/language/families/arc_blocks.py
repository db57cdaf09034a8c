"""G02, G03: circular arcs in G17, G18, G19 by the centre (I J K) or by the radius (R)."""

import math

from controller.commands import Arc
from controller.language.draft import Draft
from controller.language.families.feed_blocks import feed_in_force
from controller.language.lexer import Word
from controller.language.sync_checks import check_axes
from controller.tables.codes import Group, g_name

G02, G17, G18, G19 = 20, 170, 180, 190
_BASIC = {G17: ("X", "Y"), G18: ("Z", "X"), G19: ("Y", "Z")}
"""plane -> first and second basic axis, right-handed"""
_BASIC_AXES = {"X": 1, "Y": 2, "Z": 3}
"""as parameter 1022 names them"""
_CENTRE_LETTER = {"X": "I", "Y": "J", "Z": "K"}
Point = tuple[float, float]
_NOTHING = 1e-9
"""[mm] far below the least increment"""


def centre_by_radius(end: Point, radius: float, *, clockwise: bool) -> Point | None:
    """Centre of the arc from the origin to `end` in a right-handed plane; None where there is none.

    A positive radius means the arc up to 180 degrees, a negative one the longer.
    """
    chord = math.hypot(*end)
    if chord < _NOTHING or chord > 2.0 * abs(radius):
        return None
    height = math.sqrt(max(0.0, radius**2 - (chord / 2.0) ** 2))
    side = height / chord * (-1.0 if clockwise else 1.0) * math.copysign(1.0, radius)
    return end[0] / 2.0 - side * end[1], end[1] / 2.0 + side * end[0]


def equidistant(centre: Point, end: Point) -> Point:
    """The point nearest to `centre` as far from the origin as from `end`: rounded words, a true circle."""
    chord = math.hypot(*end)
    if chord < _NOTHING:
        return centre
    along = (centre[0] * end[0] + centre[1] * end[1]) / chord - chord / 2.0
    return centre[0] - along * end[0] / chord, centre[1] - along * end[1] / chord


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
        number = _BASIC_AXES[letter]
        for column, delivered in enumerate(draft.machine.parameters.letters):
            basic = draft.machine.parameters.integer(1022, delivered) == number
            if basic and not draft.machine.axes[column].rotary:
                columns.append(column)
                break
        else:
            place = draft.code_word(code) or draft.code_word(draft.modal.codes[Group.MOTION])
            raise draft.alarm("PS0021", f"an arc in {g_name(code)} without linear axis {letter}", place)
    return (columns[0], columns[1]), letters


def _by_radius(
    draft: Draft, end: Point, word: Word, centre_words: list[Word | None], *, clockwise: bool
) -> Point:
    for one in centre_words:
        if one:
            raise draft.alarm("PS0022", f"{one} beside {word}", one, valid="either R or I J K")
    radius = draft.reader.length(word)
    chord = math.hypot(*end)
    if chord < _NOTHING or radius == 0.0:
        valid = "an end away from the start; I and K for a full circle"
        raise draft.alarm("PS0020", f"{word} over a chord of {chord:g} mm", word, valid=valid)
    if 0.0 < chord / 2.0 - abs(radius) <= _tolerance(draft):
        return end[0] / 2.0, end[1] / 2.0
    centre = centre_by_radius(end, radius, clockwise=clockwise)
    if centre is None:
        valid = f"a radius of at least {chord / 2.0:.3f} mm"
        raise draft.alarm("PS0020", f"{word} over a chord of {chord:.3f} mm", word, valid=valid)
    return centre


def _by_centre(draft: Draft, end: Point, words: list[Word | None]) -> Point:
    first, second = (draft.reader.length(word) if word else 0.0 for word in words)
    start_radius = math.hypot(first, second)
    end_radius = math.hypot(end[0] - first, end[1] - second)
    word = next(word for word in words if word)
    if start_radius == 0.0:
        raise draft.alarm("PS0022", "a radius of 0", word, valid="I J K from the start point to the centre")
    if abs(start_radius - end_radius) > _tolerance(draft):
        found = f"a radius of {start_radius:.3f} mm at the start, {end_radius:.3f} at the end"
        raise draft.alarm("PS0020", found, word, valid=f"within {_tolerance(draft):g} mm (parameter 3410)")
    return equidistant((first, second), end)


def _tolerance(draft: Draft) -> float:
    return draft.machine.parameters.number(3410)
