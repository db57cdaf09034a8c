"""One line of text into words: an address letter and its number, kept as text until its unit is known."""

import re
from dataclasses import dataclass
from enum import Enum

from controller.alarms import AlarmError, alarm
from controller.span import Span


@dataclass(frozen=True, slots=True)
class Word:
    """An address with its number. Positional, because a million of them are made."""

    address: str
    """one capital letter; "/" for a block skip"""
    text: str
    """sign, digits and point, as written; empty after a bare address"""
    column: int
    """of the address, from 1"""

    @property
    def has_point(self) -> bool:
        """Whether the number was written with a decimal point."""
        return "." in self.text

    def __str__(self) -> str:
        return self.address + self.text


class _Fault(Enum):
    """How a number can be written wrongly, by alarm number."""

    MANY_DIGITS = "PS0003"
    BREAK = "PS0004"
    NO_DATA = "PS0005"
    MINUS = "PS0006"
    POINT = "PS0007"
    ADDRESS = "PS0009"


_WORD = re.compile(r"([A-Za-z])[ \t]*([+-]?(?:\d+\.?\d*|\.\d+))(?![\d.+-])", re.ASCII)
_SKIP = re.compile(r"/(\d?)", re.ASCII)
_COMMENT = re.compile(r"\([^)]*\)")
_BLANK = re.compile(r"[ \t\u3000]+")
_MACRO = re.compile(r"#|\[|IF|WHILE|GOTO|DO\d|END\d|THEN", re.IGNORECASE)
_ASSIGNMENT = re.compile(r"#|[A-Za-z][ \t]*-?[#\[]")
_LETTERS = re.compile(r"[A-Za-z]")
_NUMBER_LIKE = re.compile(r"[+\-.\d \t]*", re.ASCII)
LONGEST_NUMBER = 8
"""[digits] more is PS0003"""


def lex(line: str, file: str, line_number: int) -> list[Word]:
    """The words of one line.

    Comments in parentheses, everything from ; or ；on, and % are no words. Raises AlarmError PS0003-PS0007,
    PS0009 at the word that is written wrongly, HT9004 for an open comment, HT9002 for macro statements.
    """
    words: list[Word] = []
    position, end = 0, len(line)
    while position < end:
        found = _WORD.match(line, position)
        if found:
            text = found.group(2)
            if len(text) > LONGEST_NUMBER and sum(map(str.isdigit, text)) > LONGEST_NUMBER:
                raise _error(_Fault.MANY_DIGITS, found.group(), file, line_number, position)
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
        elif character == "/" and all(word.address == "N" for word in words):
            skip = _SKIP.match(line, position)
            words.append(Word("/", skip.group(1) if skip else "", position + 1))
            position = skip.end() if skip else position + 1
        else:
            raise _wrong(line, position, file, line_number)
    return words


def _wrong(line: str, position: int, file: str, line_number: int) -> AlarmError:
    """What exactly is wrong with the text at `position`, where no word begins."""
    place = Span(file=file, line=line_number, column=position + 1)
    if _MACRO.match(line, position) or _ASSIGNMENT.match(line, position):
        return alarm("HT9002", f"the custom macro statement {_snippet(line[position:])}", place)
    if not _LETTERS.match(line, position):
        digits = _NUMBER_LIKE.match(line, position)
        lone = digits is not None and digits.end() > position
        fault = _Fault.BREAK if lone or line[position] in "/)" else _Fault.ADDRESS
        return _error(fault, _snippet(line[position:]), file, line_number, position)
    number = _NUMBER_LIKE.match(line, position + 1)
    text = number.group().strip() if number else ""
    word = line[position] + text
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


def _snippet(text: str) -> str:
    """The first word of `text`, short enough for a message."""
    return (text.split() or [text])[0][:20]
