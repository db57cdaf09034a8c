"""One line of text into words: an address letter and its number, kept as text until its unit is known."""

import re
from enum import Enum
from typing import NamedTuple

from controller.language.macro.expression import Expression, Scanner, parse_primary, printable
from controller.span import Span
from controller.tables.alarms import AlarmError, alarm


class Word(NamedTuple):
    """An address with its number."""

    address: str
    """one capital letter; "/" for a block skip"""
    text: str
    """sign, digits and point, or the expression, as written"""
    column: int
    """of the address, from 1"""
    value: float | None = None
    """the result of an expression, in units; None for a number"""

    @property
    def has_point(self) -> bool:
        """Whether a number was written with a decimal point."""
        return self.value is None and "." in self.text

    @property
    def negative(self) -> bool:
        """Whether the number has a minus sign."""
        return self.text.startswith("-") if self.value is None else self.value < 0.0

    def __str__(self) -> str:
        return self.address + self.text + ("" if self.value is None else f" = {self.value:.9g}")


class OpenWord(NamedTuple):
    """An address with an expression that is evaluated whenever the block is executed: X#1, Z[#2-3.]."""

    address: str
    text: str
    """the expression as written"""
    column: int
    expression: Expression


class _Fault(Enum):
    """How a number can be written wrongly, by alarm number."""

    MANY_DIGITS = "PS0003"
    BREAK = "PS0004"
    NO_DATA = "PS0005"
    MINUS = "PS0006"
    POINT = "PS0007"
    ADDRESS = "PS0009"


_WORD = re.compile(r"([A-Za-z])[ \t]*([+-]?(?:\d+\.?\d*|\.\d+))(?![\d.+-])[ \t]*", re.ASCII)
_OPEN = re.compile(r"([A-Za-z])[ \t]*(?=[+-]*[ \t]*[#\[])")
_SKIP = re.compile(r"/[ \t]*(\d?)(?!\d)", re.ASCII)
_COMMENT = re.compile(r"\([^)]*\)")
_BLANK = re.compile(r"[ \t\u3000]+")
_STATEMENT = re.compile(r"#|IF|WHILE|GOTO|DO[ \t]*\d|END[ \t]*\d|THEN", re.IGNORECASE)
_LETTERS = re.compile(r"[A-Za-z]")
_NUMBER_LIKE = re.compile(r"[+\-.\d \t]*", re.ASCII)
LONGEST_NUMBER = 8
"""[digits] more is PS0003"""


def lex(line: str, file: str, line_number: int) -> list[Word | OpenWord]:
    """The words of one line.

    Comments in parentheses, everything from ; or ；on, and % are no words. Raises AlarmError PS0003-PS0007,
    PS0009 at the word that is written wrongly, HT9004 for an open comment, PS0114 and PS0118 in expressions,
    PS0127 for a macro statement beside words.
    """
    words: list[Word | OpenWord] = []
    position, end = 0, len(line)
    while position < end:
        found = _WORD.match(line, position)
        if found:
            text = found.group(2)
            if len(text) > LONGEST_NUMBER and sum(map(str.isdigit, text)) > LONGEST_NUMBER:
                raise _error(_Fault.MANY_DIGITS, found.group().rstrip()[:20], file, line_number, position)
            words.append(Word(found.group(1).upper(), text, position + 1))
            position = found.end()
            continue
        character = line[position]
        if character in ";；":
            break
        if blank := _BLANK.match(line, position):
            position = blank.end()
        elif character == "%" and not words:
            position += 1
        elif character == "(":
            comment = _COMMENT.match(line, position)
            if comment is None:
                place = Span(file=file, line=line_number, column=position + 1)
                raise alarm("HT9004", "( without )", place)
            position = comment.end()
        elif character == "/" and (skip := _SKIP.match(line, position)) and _only_label(words):
            words.append(Word("/", skip.group(1), position + 1))
            position = skip.end()
        elif expression := _OPEN.match(line, position):
            scanner = Scanner(line, expression.end(), file, line_number)
            if expression.group(1).upper() in "NO":
                raise scanner.fault("PS0114", f"digits behind {expression.group(1).upper()}")
            parsed = parse_primary(scanner)
            text = line[expression.end() : scanner.position]
            words.append(OpenWord(expression.group(1).upper(), text, position + 1, parsed))
            position = scanner.position
        else:
            raise _wrong(line, position, file, line_number)
    return words


def _only_label(words: list[Word | OpenWord]) -> bool:
    return all(word.address == "N" for word in words)


def _wrong(line: str, position: int, file: str, line_number: int) -> AlarmError:
    """What exactly is wrong with the text at `position`, where no word begins."""
    place = Span(file=file, line=line_number, column=position + 1)
    if _STATEMENT.match(line, position):
        return alarm("PS0127", snippet(line[position:]), place)
    if not _LETTERS.match(line, position):
        digits = _NUMBER_LIKE.match(line, position)
        lone = digits is not None and digits.end() > position
        fault = _Fault.BREAK if lone or line[position] in "/)[]=*" else _Fault.ADDRESS
        return _error(fault, snippet(line[position:]), file, line_number, position)
    number = _NUMBER_LIKE.match(line, position + 1)
    text = number.group().strip() if number else ""
    word = (line[position] + text)[:20]
    if not any(map(str.isdigit, text)):
        fault = _Fault.POINT if "." in text else _Fault.NO_DATA
    elif text.count(".") > 1:
        fault = _Fault.POINT
    elif re.search(r"[+-]", text[1:]):
        fault = _Fault.MINUS
    else:
        fault = _Fault.BREAK
    return _error(fault, word, file, line_number, position)


def _error(fault: _Fault, found: str, file: str, line_number: int, position: int) -> AlarmError:
    return alarm(fault.value, found, Span(file=file, line=line_number, column=position + 1))


def snippet(text: str) -> str:
    """The first word of `text`, short enough for a message, and such that any terminal can print it."""
    return printable((text.split() or [text])[0][:20])
