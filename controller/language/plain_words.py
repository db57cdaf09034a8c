"""The words of plain blocks, as text: what the short lane takes without looking twice.

Only numbers that are truncated nowhere are plain, and that nothing has to be said about: at most three
decimals, and with a point where those without one are counted in increments (`counted`, DPI = 0).
"""

import re
from collections.abc import Callable, Sequence

from controller.tables.machine_data import INCREMENT_LETTER

Words = dict[str, tuple[str, int]]
"""address -> number, text column of the address from 1; under G the digit of G00 to G03"""
_LENGTH, _POINTED = r"\d{1,5}(?:\.\d{0,3})?|\.\d{1,3}", r"\d{1,5}\.\d{0,3}|\.\d{1,3}"
_LAST = r"(?![\d.+-])[ \t]*"
_LABEL = rf"[ \t]*(?:N[ \t]*\d{{1,8}}{_LAST})?"
_REST = r"\([^)]*\)[ \t]*|[;；].*"
"""a comment, annotation"""


def usual_order(
    letters: Sequence[str], *, counted: bool
) -> tuple[Callable[[str], "re.Match[str] | None"], list[int]]:
    """The form N G X Z … F of a straight move, and the groups of the axis letters; each number is the group
    behind. Group 1 is the digit of G, the last one the number of F."""
    number = _POINTED if counted else _LENGTH
    pattern, groups = rf"{_LABEL}(?:G0?([01]){_LAST})?", []
    for k, letter in enumerate(letters):
        pair = letter + INCREMENT_LETTER.get(letter, "")
        pattern += rf"(?:([{pair}])[ \t]*([+-]?(?:{number})){_LAST})?"
        groups.append(1 + 2 * k)
    pattern += rf"(?:F[ \t]*({number}){_LAST})?(?:{_REST})?"
    return re.compile(pattern, re.ASCII).fullmatch, groups


class PlainWords:
    """Reads lines of G00 to G03, axis words, I, K, R and F in any order, with comments between them."""

    def __init__(self, letters: Sequence[str], *, counted: bool) -> None:
        number = _POINTED if counted else _LENGTH
        addresses = "FIKR" + "".join(letter + INCREMENT_LETTER.get(letter, "") for letter in letters)
        word = rf"([{addresses}])[ \t]*([+-]?(?:{number})){_LAST}|G[ \t]*0?([0-3]){_LAST}|{_REST}"
        self._label = re.compile(_LABEL, re.ASCII).match
        self._word = re.compile(word, re.ASCII).match

    def read(self, line: str) -> Words | None:
        """The words but N; None where anything else stands in the line, an address twice, or a sign of F."""
        label = self._label(line)
        position, words = label.end() if label else 0, Words()
        while word := self._word(line, position):
            letter, text, digit = word.groups()
            if digit:
                letter, text = "G", digit
            if letter:
                if letter in words or (letter == "F" and text[0] in "+-"):
                    return None
                words[letter] = text, position + 1
            position = word.end()
        return words if position == len(line) else None
