"""Chapters on alarms, warnings and advice."""

from collections.abc import Iterator

from controller.tables.alarm_notes import note_of
from controller.tables.alarms import ALARMS, AlarmClass, Severity
from twin.advice.kinds import KINDS
from twin.manual.entry import Chapter, Entry

_KEEP_SYNC = frozenset({AlarmClass.PROGRAM, AlarmClass.USER})
"""classes that leave the gear box on (hobbing, 注意事项)"""


def alarms() -> Iterator[Entry]:
    """Every alarm that stops a program."""
    for _, entry in sorted(ALARMS.items()):
        if entry.severity is not Severity.ERROR:
            continue
        note = note_of(entry)
        sync = "stays on" if entry.kind in _KEEP_SYNC else "is cancelled"
        yield Entry(
            chapter=Chapter.ALARM,
            name=entry.number,
            title=entry.text,
            rows=(
                *_row("Meaning", note.meaning),
                ("Class", f"{entry.kind.value}; the gear box {sync}"),
                *_row("Raised by", ", ".join(note.codes)),
                ("Remedy", entry.remedy),
                ("Clause", note.clause),
            ),
            names=_names(entry.number),
        )


def warnings() -> Iterator[Entry]:
    """Every warning of the controller."""
    for _, entry in sorted(ALARMS.items()):
        if entry.severity is Severity.WARNING:
            note = note_of(entry)
            yield Entry(
                chapter=Chapter.WARNING,
                name=entry.number,
                title=entry.text,
                rows=(
                    *_row("Meaning", note.meaning),
                    *_row("Raised by", ", ".join(note.codes)),
                    ("Remedy", entry.remedy),
                    ("Clause", note.clause),
                ),
                names=_names(entry.number),
            )


def advice() -> Iterator[Entry]:
    """Every kind of advice on a job."""
    for entry in KINDS.values():
        yield Entry(
            chapter=Chapter.ADVICE,
            name=entry.kind.value,
            title=entry.text,
            rows=(("Weight", entry.weight.value), ("Remedy", entry.remedy), ("Clause", entry.clause)),
            names=_names(entry.kind.value),
        )


def _row(label: str, text: str) -> tuple[tuple[str, str], ...]:
    return ((label, text),) if text else ()


def _names(number: str) -> frozenset[str]:
    """PS0005 is found as PS5 and 0005, too."""
    letters, digits = number[:2], number[2:]
    short = digits.lstrip("0") or "0"
    return frozenset({number, f"{letters}{short}", digits})
