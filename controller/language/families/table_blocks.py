"""G10 L60 to L62, a form of our own: corrections of axes against the work angle (docs/probing.md).

G10 L60 Q72             a new table of 72 points, all nought; point 1 stands at C0, the next 5° further
G10 L60 P1 X0.034 C-0.09  what is added there: X as programmed (in diameter), C in degrees
G10 L61                 on: it comes in within half a second, and holds as the work turns
G10 L62                 off
"""

from controller.commands import ClearTable, SetTablePoint, SwitchTable
from controller.language.draft import Draft
from controller.language.lexer import Word

G10 = 100
TABLE, ON, OFF = 60, 61, 62
FEWEST, MOST = 3, 3600


def set_table(draft: Draft, kind: int, number: Word | None) -> None:
    """A block of L60, L61 or L62; `number` is its P."""
    if kind in (ON, OFF):
        draft.commands.append(SwitchTable(on=kind == ON, span=draft.block.span))
        if number is not None:
            raise draft.alarm("PS0009", f"{number} with G10 L{kind}", number, valid="L61 or L62 alone")
        return
    count = draft.take("Q")
    absolute, incremental = draft.axis_words()
    for word in incremental.values():
        raise draft.alarm("PS0009", f"{word} with G10 L60", word, valid="X, Z, Y or C of the point")
    if number is None:
        points = draft.reader.natural(count) if count is not None else 0
        if not FEWEST <= points <= MOST or absolute:
            valid = f"Q, the number of its points, {FEWEST} to {MOST}, and nothing else; or P, a point of it"
            raise draft.alarm(
                "HT9012", f"G10 L60 {count or 'alone'}", count or draft.code_word(G10), valid=valid
            )
        draft.commands.append(ClearTable(points=points, span=draft.block.span))
        return
    if count is not None:
        raise draft.alarm("PS0009", f"{count} with P", count, valid="Q without P for a new table")
    if not absolute:
        raise draft.alarm("HT9012", f"G10 L60 {number} without a value", number, valid="X, Z, Y or C")
    draft.commands.append(
        SetTablePoint(
            number=draft.reader.natural(number),
            values={column: draft.axis_value(column, word) for column, word in absolute.items()},
            span=draft.block.span,
        )
    )
