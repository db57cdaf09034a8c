"""G00, G01: straight moves of the axis words of a block."""

from collections.abc import Mapping

from controller.commands import Feed, Move
from controller.language.draft import Draft
from controller.language.families.feed_blocks import feed_in_force
from controller.language.lexer import Word
from controller.language.sync_checks import check_axes
from controller.tables.codes import Group

G00, G01 = 0, 10


def straight(draft: Draft) -> None:
    """The move of the axis words by the modal G00 or G01, if there are any."""
    if draft.rest and (move := move_of_words(draft, rapid=draft.modal.codes[Group.MOTION] == G00)):
        draft.commands.append(move)


def move_of_words(draft: Draft, *, rapid: bool) -> Move | None:
    """The straight move of the axis words of the block; None where there are none."""
    absolute, incremental = draft.axis_words()
    words = absolute | incremental
    if not words:
        return None
    check_axes(draft, absolute, incremental)
    feed = None if rapid else feed_in_force(draft, words)
    return move_of(draft, absolute, incremental, feed)


def move_of(
    draft: Draft, absolute: Mapping[int, Word], incremental: Mapping[int, Word], feed: Feed | None
) -> Move:
    """The move to positions and by increments that words name."""
    return Move(
        absolute={column: draft.axis_value(column, word) for column, word in absolute.items()},
        incremental={column: draft.axis_value(column, word) for column, word in incremental.items()},
        feed=feed,
        places={column: word.column for column, word in {**absolute, **incremental}.items()},
    )
