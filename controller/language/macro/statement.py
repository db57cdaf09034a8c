"""Macro statements: assignment, IF, GOTO, WHILE, DO and END, parsed once a line.

A block is either one macro statement or words; both in one block is PS0127.
"""

import re
from dataclasses import dataclass

from controller.language.macro.expression import (
    Expression,
    Scanner,
    parse_condition,
    parse_expression,
    parse_primary,
    parse_variable,
)
from controller.span import Span
from controller.tables.alarms import alarm

_LOOP_NUMBERS = frozenset("123")
_BLANKS = r"(?:[ \t\u3000]|\([^)]*\))*"
_BEGINNING = re.compile(
    rf"{_BLANKS}(?:/{_BLANKS}(?P<early>\d?)(?!\d))?{_BLANKS}(?:N[ \t]*\d{{1,8}}(?!\d))?"
    rf"{_BLANKS}(?:/{_BLANKS}(?P<late>\d?)(?!\d))?{_BLANKS}(?=#|IF|GOTO|WHILE|DO|END)",
    re.IGNORECASE | re.ASCII,
)
_LOOP_WORD = re.compile(r"(?<![A-Z])(DO|END)[ \t]*(\d+)", re.IGNORECASE | re.ASCII)
_KEYWORD = re.compile(r"IF|GOTO|WHILE|DO|END|THEN", re.IGNORECASE)
_DIGITS = re.compile(r"\d+", re.ASCII)
_COMMENT = re.compile(r"\(([^)]*)\)")
_ANNOTATION = re.compile("[;；].*")


@dataclass(frozen=True, slots=True, kw_only=True)
class Assign:
    """#i = expression."""

    number: Expression
    value: Expression
    place: Span
    """of the variable"""
    comment: str
    """the comment of the block: the message of #3000 and #3006"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Jump:
    """GOTO n, with or without IF."""

    condition: Expression | None
    target: Expression
    place: Span
    """of the sequence number"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Conditional:
    """IF [...] THEN #i = expression."""

    condition: Expression
    then: Assign


@dataclass(frozen=True, slots=True, kw_only=True)
class Loop:
    """WHILE [...] DO m; without condition DO m, which only GOTO and M99 leave."""

    condition: Expression | None
    number: int
    place: Span


@dataclass(frozen=True, slots=True, kw_only=True)
class LoopEnd:
    """END m."""

    number: int
    place: Span


Action = Assign | Jump | Conditional | Loop | LoopEnd


@dataclass(frozen=True, slots=True, kw_only=True)
class Statement:
    """A macro statement as a block."""

    action: Action
    skip: int | None
    """n of /n; None = the block is not to be skipped"""
    span: Span


def parse_statement(line: str, file: str, line_number: int) -> Statement | None:
    """The macro statement of a line; None where the line holds none.

    Raises AlarmError PS0114 for its form, PS0118, PS0124-PS0128.
    """
    found = _BEGINNING.match(line)
    if found is None:
        return None
    scanner = Scanner(line, found.end(), file, line_number)
    span = scanner.place()
    comment = _COMMENT.search(line)
    action = _action(scanner, comment.group(1).strip() if comment else "")
    if not scanner.finished:
        raise scanner.fault("PS0127", "one macro statement in a block, and no words beside it")
    mark = found["early"] if found["early"] is not None else found["late"]
    return Statement(action=action, skip=None if mark is None else int(mark or 1), span=span)


def _action(scanner: Scanner, comment: str) -> Action:
    place = scanner.place()
    if scanner.take("#"):
        return _assign(scanner, comment, place)
    keyword = (scanner.match(_KEYWORD) or "").upper()
    if keyword == "IF":
        return _if(scanner, comment)
    if keyword == "GOTO":
        return _jump(scanner, None)
    if keyword == "END":
        return LoopEnd(number=_loop_number(scanner), place=place)
    condition = parse_condition(scanner) if keyword == "WHILE" else None
    if condition and (scanner.match(_KEYWORD) or "").upper() != "DO":
        raise scanner.fault("PS0114", "DO behind the condition")
    return Loop(condition=condition, number=_loop_number(scanner), place=place)


def _if(scanner: Scanner, comment: str) -> Jump | Conditional:
    condition = parse_condition(scanner)
    follows = (scanner.match(_KEYWORD) or "").upper()
    if follows == "GOTO":
        return _jump(scanner, condition)
    if follows != "THEN":
        raise scanner.fault("PS0114", "GOTO n or THEN #i = ... behind the condition")
    target = scanner.place()
    if not scanner.take("#"):
        raise scanner.fault("PS0114", "an assignment behind THEN")
    return Conditional(condition=condition, then=_assign(scanner, comment, target))


def _assign(scanner: Scanner, comment: str, place: Span) -> Assign:
    """What follows # at the beginning of an assignment."""
    number = parse_variable(scanner)
    if not scanner.take("="):
        raise scanner.fault("PS0114", "= behind the variable")
    return Assign(number=number, value=parse_expression(scanner), place=place, comment=comment)


def _jump(scanner: Scanner, condition: Expression | None) -> Jump:
    place = scanner.place()
    return Jump(condition=condition, target=parse_primary(scanner), place=place)


def _loop_number(scanner: Scanner) -> int:
    place = scanner.place()
    text = scanner.match(_DIGITS)
    if text is None:
        raise scanner.fault("PS0126", "1, 2 or 3")
    if text not in _LOOP_NUMBERS:
        raise alarm("PS0126", text[:20], place, valid="1, 2 or 3")
    return int(text)


def matching_end(lines: list[str], index: int, end: int, loop: Loop) -> int:
    """Index of the END of the loop that begins at line `index`, looked for before line `end`.

    Raises AlarmError PS0124 where DO and END do not pair, or a number is used again inside.
    """
    open_loops = [loop.number]
    for k in range(index + 1, end):
        line = lines[k]
        if "D" not in line and "d" not in line:
            continue
        for found in _LOOP_WORD.finditer(_ANNOTATION.sub("", _COMMENT.sub("", line))):
            number = int(found.group(2)[:9])
            if found.group(1).upper() == "END":
                if number != open_loops[-1]:
                    break
                open_loops.pop()
                if not open_loops:
                    return k
            elif number in open_loops:
                break
            else:
                open_loops.append(number)
        else:
            continue
        raise alarm(
            "PS0124",
            f"{found.group().strip()} on line {k + 1} inside DO{open_loops[-1]}",
            loop.place,
            valid="loops that lie wholly inside each other, each with its own number",
        )
    raise alarm("PS0124", f"DO{loop.number} without END{loop.number}", loop.place)
