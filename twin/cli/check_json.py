"""A check for machines: one JSON object, or the annotations of a GitHub workflow."""

import json
from collections.abc import Iterator

from controller.span import Span
from controller.tables.alarms import Alarm, as_json
from twin.advice.advice import Advice, advice_as_json, as_warning
from twin.cli.check_result import CheckResult

_DIGITS = 6


def as_json_text(result: CheckResult) -> str:
    """The result as one JSON object, a line for each key; the keys are listed in docs/check.md."""
    lines = (
        f"  {json.dumps(key)}: {json.dumps(value, ensure_ascii=False, allow_nan=False)}"
        for key, value in _object(result).items()
    )
    return "{\n" + ",\n".join(lines) + "\n}"


def refused_as_json(alarm: Alarm) -> str:
    """What there is to say where the program or the parameters are refused whole and nothing was run."""
    empty: dict[str, object] = {"absolute": {}, "machine": {}}
    return json.dumps(
        {"alarms": [as_json(alarm)], "warnings": [], "cycle_time_s": 0.0, "final": empty, "extents": {}},
        ensure_ascii=False,
    )


def _object(result: CheckResult) -> dict[str, object]:
    run = result.run
    return {
        "alarms": [_message(one) for one in (*run.alarms, *result.read_on)],
        "warnings": [_message(one) for one in result.warnings],
        "read_on": len(result.read_on),
        "cycle_time_s": round(run.cycle_time_s, _DIGITS),
        "units": {"linear": "mm", "rotary": "deg"},
        "final": {
            "absolute": dict(run.absolute),
            "relative": dict(run.relative),
            "machine": dict(run.machine),
        },
        "extents": {
            letter: {"absolute": list(one.absolute), "machine": list(one.machine)}
            for letter, one in run.extents.items()
        },
        "peaks": {
            letter: {
                "speed": round(one.speed, _DIGITS),
                "speed_limit": round(one.speed_limit, _DIGITS),
                "speed_unit": "rpm" if letter in run.turns else "mm/min",
                "acceleration": round(one.acceleration, _DIGITS),
                "acceleration_limit": round(one.acceleration_limit, _DIGITS),
                "acceleration_unit": "rpm/s" if letter in run.turns else "mm/s2",
            }
            for letter, one in run.peaks.items()
        },
        "turns": {letter: round(turns, _DIGITS) for letter, turns in run.turns.items()},
        "sync": [
            {
                "kind": one.kind.value,
                "start_s": round(one.start_s, _DIGITS),
                "end_s": round(one.end_s, _DIGITS),
                "first_line": one.first_line,
                "last_line": one.last_line,
            }
            for one in run.sync
        ],
        "in_sync_at_end": run.in_sync_at_end,
        "blocks": _blocks(result),
        "signals": {name: int(level) for name, level in run.signals.items()},
        "advice": [advice_as_json(one) for one in result.advice],
    }


def _blocks(result: CheckResult) -> dict[str, list[object]]:
    """Columns, as there may be a million blocks; `file` where there is more than one."""
    program, blocks = result.program, result.run.blocks
    lines: list[int] = list(blocks.line)
    places = {line: program.span(line - 1) for line in set(lines) if line}
    columns: dict[str, list[object]] = {
        "line": [places[line].line if line else 0 for line in lines],
        "start_s": [round(value, _DIGITS) for value in blocks.start_s],
        "duration_s": [round(value, _DIGITS) for value in blocks.duration_s],
    }
    if any(place.file != program.file for place in places.values()):
        columns["file"] = [places[line].file if line else None for line in lines]
    return columns


def _message(one: Alarm | Advice) -> dict[str, str | int | None]:
    return as_json(one) if isinstance(one, Alarm) else as_warning(one)


def as_github(result: CheckResult) -> Iterator[str]:
    """Workflow commands; their property values escape %, line ends, colon and comma."""
    yield from map(annotation, result.messages)


def annotation(one: Alarm | Advice) -> str:
    """One workflow command."""
    word = one.severity.value if isinstance(one, Alarm) else one.weight.value
    text = f"{one.number}: {one.text}: {one.found}; valid: {one.remedy}".replace("%", "%25")
    return f"::{word if word != 'note' else 'notice'}{_place(one.span)}::{text}"


def _place(span: Span | None) -> str:
    if span is None:
        return ""
    file = span.file.replace("%", "%25").replace(":", "%3A").replace(",", "%2C")
    return f" file={file},line={span.line or 1},col={span.column or 1}"
