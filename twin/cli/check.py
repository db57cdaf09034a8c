"""`hobtwin check`: the controller alone."""

import argparse
import json
from pathlib import Path

from controller.alarms import Alarm, as_json
from controller.dry_run import DryRun, dry_run
from controller.offsets import Offsets
from controller.parameters import delivered
from controller.source import load_program
from twin.errors import ExitCode, InputError, Place


def check_command(options: argparse.Namespace) -> ExitCode:
    """Check a program or a job's program. Raises HobtwinError and ControllerError."""
    target: Path = options.target
    overrides = dict(_pair(text, "--parameter 201#4=1") for text in options.parameter)
    asked = dict(_pair(text, "--signal NOZAGC=1") for text in options.signal)
    signals = {name: value != "0" for name, value in asked.items()}
    if target.is_dir() or target.suffix == ".toml":
        from twin.job import read_job  # noqa: PLC0415 - a bare program needs none of this
        from twin.presets import cutters_of, settings_of  # noqa: PLC0415

        job = read_job(target)
        if options.setup and options.setup != job.machine.setup:
            raise InputError(f"--setup {options.setup}: the job says {job.machine.setup}")
        settings = settings_of(job, cutters_of(job), parameters=overrides, signals=signals)
        parameters, offsets, signals = settings.parameters, settings.offsets, settings.signals
        program = load_program(job.program)
    else:
        if not target.exists():
            raise InputError("there is no such file", place=Place(file=str(target)))
        parameters = delivered(options.setup or "hobbing", overrides)
        program, offsets = load_program(target), Offsets()
    found = dry_run(program, parameters, offsets, signals)
    _print(found, options.format)
    return ExitCode.FINDING if found.alarms or (options.strict and found.warnings) else ExitCode.FINE


def _pair(text: str, example: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not equals or not name or not value:
        raise InputError(f"{text!r} is no name=value", remedy=f"valid: {example}")
    return name.strip(), value.strip()


def _print(found: DryRun, form: str) -> None:
    if form == "json":
        print(json.dumps(_json(found), indent=2, ensure_ascii=False))
        return
    for alarm in (*found.warnings, *found.alarms):
        print(_github(alarm) if form == "github" else alarm)
    if form == "github":
        return
    for name, values in (("absolute", found.absolute), ("machine", found.machine)):
        print(f"{name:<9}" + "".join(f"  {letter}{value:.3f}" for letter, value in values.items()))
    said = f"{len(found.alarms)} alarm(s), {len(found.warnings)} warning(s)"
    print(f"cycle time {found.cycle_time_s:.1f} s; {said}")


def _github(alarm: Alarm) -> str:
    """A workflow command; its property values escape %, line ends, colon and comma."""
    place = ""
    if alarm.span:
        file = alarm.span.file.replace("%", "%25").replace(":", "%3A").replace(",", "%2C")
        place = f" file={file},line={alarm.span.line or 1},col={alarm.span.column or 1}"
    text = f"{alarm.number}: {alarm.text}: {alarm.found}; valid: {alarm.remedy}"
    return f"::{alarm.severity.value}{place}::{text.replace('%', '%25')}"


def _json(found: DryRun) -> dict[str, object]:
    return {
        "alarms": [as_json(a) for a in found.alarms],
        "warnings": [as_json(a) for a in found.warnings],
        "cycle_time_s": found.cycle_time_s,
        "final": {"absolute": dict(found.absolute), "machine": dict(found.machine)},
        "extents": {
            letter: {"absolute": list(e.absolute), "machine": list(e.machine)}
            for letter, e in found.extents.items()
        },
    }
