"""Chapters on G and M codes."""

from collections.abc import Iterator

from controller.tables.alarm_notes import NOTES
from controller.tables.alarms import ALARMS
from controller.tables.codes import G_CODES, M_CODES, POWER_ON, Group, Support
from twin.manual.entry import Chapter, Entry, spelled

_M_CLAUSE = "rulings, section 1, M codes"
_SUPPORTED = {
    Support.RUNS: "yes",
    Support.NEVER: "no: HT9003, rather than a wrong path",
}


def g_codes() -> Iterator[Entry]:
    """Every G code of the controller."""
    for _, code in sorted(G_CODES.items()):
        lasts = "one block only" if code.group is Group.ONE_SHOT else "modal"
        power_on = ", in force at power-on" if POWER_ON.get(code.group) == code.tenths else ""
        yield Entry(
            chapter=Chapter.G_CODE,
            name=code.name,
            title=code.meaning,
            rows=(
                ("Group", f"{code.group.value}, {lasts}{power_on}"),
                ("Supported", _SUPPORTED[code.support]),
                *_raised(code.name),
                ("Clause", code.clause),
            ),
            names=frozenset({spelled(code.name), f"G{code.tenths / 10:g}"}),
        )


def m_codes() -> Iterator[Entry]:
    """Every M code of the machine."""
    for code in M_CODES.values():
        yield Entry(
            chapter=Chapter.M_CODE,
            name=code.name,
            title=code.meaning,
            rows=(("Acts", code.moment.value), *_raised(code.name), ("Clause", _M_CLAUSE)),
            names=frozenset({code.name, f"M{code.number}"}),
        )


def _raised(code: str) -> Iterator[tuple[str, str]]:
    """The alarms that name the code as their source."""
    numbers = [number for number, note in NOTES.items() if code in note.codes and number in ALARMS]
    if numbers:
        yield "Can raise", "; ".join(f"{number} {ALARMS[number].text}" for number in numbers)
