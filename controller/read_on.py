"""What a program still holds behind its first alarm: lines read one by one, not run.

A controller stops at its first alarm, and so does a dry run. Behind it positions, modal codes and the gear
box are unknown; only what a line says by itself can honestly be called wrong: words, codes, ranges.
"""

from collections.abc import Iterator
from dataclasses import replace
from itertools import islice

from controller.dry_run import dry_run
from controller.language.source import Program, parse_program
from controller.tables.alarms import Alarm, AlarmError
from controller.tables.machine_data import INCREMENT_LETTER, machine_data
from controller.tables.parameters import Parameters

BY_ITSELF = frozenset(
    (
        *("PS0003", "PS0004", "PS0005", "PS0007", "PS0010", "PS0022", "PS0030", "PS0218", "PS0219"),
        *("PS1593", "PS1594", "PS5007", "PS5016", "PS5074"),
        *("HT9003", "HT9004", "HT9009", "HT9010", "HT9014"),
    )
)
"""alarms that no state of the machine can excuse"""
MOST_LINES = 20_000
MOST_ALARMS = 100
_ADDRESSES = frozenset("FGIJKLMNOPQRST")
_MACRO = frozenset("#[")


def alarms_behind(program: Program, parameters: Parameters, line: int) -> tuple[Alarm, ...]:
    """Alarms of the lines behind `line` (from 1): at most `MOST_ALARMS`, in at most `MOST_LINES` lines."""
    return tuple(islice(_alarms(program, parameters, line), MOST_ALARMS))


def _alarms(program: Program, parameters: Parameters, line: int) -> Iterator[Alarm]:
    letters = machine_data(parameters).letters
    known = _ADDRESSES.union(letters, (INCREMENT_LETTER.get(letter, letter) for letter in letters))
    for index in range(line, min(len(program.lines), line + MOST_LINES)):
        text = program.lines[index]
        if _MACRO.isdisjoint(text):
            one = _alarm_of(text, program.file, parameters)
            if one and one.span and _by_itself(one, text, known):
                yield replace(one, span=replace(one.span, line=index + 1))


def _alarm_of(text: str, file: str, parameters: Parameters) -> Alarm | None:
    """The first alarm of a line that is a program of its own."""
    try:
        found = dry_run(parse_program(text, file=file), parameters)
    except AlarmError as error:
        return error.alarm
    return found.alarms[0] if found.alarms else None


def _by_itself(one: Alarm, text: str, known: frozenset[str]) -> bool:
    """An address is improper by itself only where no code could give it a meaning."""
    if one.number == "PS0009" and one.span and one.span.column:
        return text[one.span.column - 1].upper() not in known
    if one.number == "PS0006":  # one sign may have its state, two have none
        return any(sign in one.found[2:] for sign in "+-")
    return one.number in BY_ITSELF
