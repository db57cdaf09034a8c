"""Chapter on parameters: range, delivered values of both set-ups, bits."""

from collections.abc import Iterator

from controller.tables.delivered import SETUPS
from controller.tables.parameter_table import PARAMETERS, ParameterEntry, ParameterKind
from controller.tables.parameters import Parameters, delivered
from twin.manual.entry import Chapter, Entry


def parameters() -> Iterator[Entry]:
    """Every parameter, and every bit of a bit parameter."""
    sets = {setup: delivered(setup) for setup in SETUPS}
    for _, entry in sorted(PARAMETERS.items()):
        if entry.kind is ParameterKind.BITS:
            for bit, meaning in entry.bits.items():
                name = f"{entry.number}#{bit}"
                yield Entry(
                    chapter=Chapter.PARAMETER,
                    name=name,
                    title=meaning,
                    rows=(
                        ("Range", "0 or 1" + _per_axis(entry)),
                        *_delivered(entry, sets, bit),
                        ("Clause", entry.clause),
                    ),
                    names=_names(entry, sets, f"#{bit}") | {str(entry.number)},
                )
            continue
        range_ = f"{entry.low:.10g} to {entry.high:.10g} {entry.unit}".rstrip() + _per_axis(entry)
        if entry.kind is ParameterKind.LETTER:
            range_ = f"{chr(int(entry.low))} to {chr(int(entry.high))}" + _per_axis(entry)
        yield Entry(
            chapter=Chapter.PARAMETER,
            name=str(entry.number),
            title=entry.meaning,
            rows=(("Range", range_), *_delivered(entry, sets, None), ("Clause", entry.clause)),
            names=_names(entry, sets, ""),
        )


def _per_axis(entry: ParameterEntry) -> str:
    return f", one for each axis, as {entry.number}{'#0' if entry.bits else ''}.X" if entry.per_axis else ""


def _names(entry: ParameterEntry, sets: dict[str, Parameters], bit: str) -> frozenset[str]:
    name = f"{entry.number}{bit}"
    if not entry.per_axis:
        return frozenset({name})
    letters = {letter for one in sets.values() for letter in one.letters}
    return frozenset({name, *(f"{name}.{letter}" for letter in letters)})


def _delivered(
    entry: ParameterEntry, sets: dict[str, Parameters], bit: int | None
) -> Iterator[tuple[str, str]]:
    """The delivered values, once where both set-ups agree."""
    shown = {setup: _values(entry, one, bit) for setup, one in sets.items()}
    if len(set(shown.values())) == 1:
        yield "Delivered", next(iter(shown.values()))
        return
    for setup, text in shown.items():
        yield f"Delivered ({setup})", text


def _values(entry: ParameterEntry, one: Parameters, bit: int | None) -> str:
    if not entry.per_axis:
        return _value(entry, one, bit, "")
    shown = {
        letter: _value(entry, one, bit, letter)
        for letter in one.letters
        if (entry.number, letter) in one.values
    }
    return ", ".join(f"{letter} {value}" for letter, value in shown.items()) or "none"


def _value(entry: ParameterEntry, one: Parameters, bit: int | None, letter: str) -> str:
    if (entry.number, letter) not in one.values:
        return "none"
    if bit is not None:
        return str(int(one.bit(entry.number, bit, letter)))
    value = one.number(entry.number, letter)
    return chr(int(value)) if entry.kind is ParameterKind.LETTER else f"{value:.10g}"
