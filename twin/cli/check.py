"""`hobtwin check`: the controller alone."""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

from controller.dry_run import DryRun, dry_run
from controller.language.offsets import Offsets
from controller.language.source import Program, load_program
from controller.observed import Observed
from controller.read_on import alarms_behind
from controller.tables.alarms import AlarmError
from controller.tables.machine_data import MachineData, machine_data
from controller.tables.parameters import delivered
from controller.trace import trace_alarm, trace_line
from twin.cli.check_result import CheckResult
from twin.cli.check_text import as_text
from twin.cli.given import given_by
from twin.errors import ExitCode, InputError, Place

Observer = Callable[[Observed], None]
_JOB = "job.toml"


def check_command(options: argparse.Namespace) -> ExitCode:
    """Check a program or a job's program. Raises HobtwinError and ControllerError."""
    if options.trace and options.format != "text":
        raise InputError(f"--trace with --format {options.format}", remedy="one of the two")
    target: Path = options.target
    of_job = target.suffix == ".toml" or (target / _JOB).is_file()
    try:
        result = _check_job(options) if of_job else _check_program(options)
    except AlarmError as refused:
        if options.format == "text":
            raise
        from twin.cli.check_json import annotation, refused_as_json  # noqa: PLC0415

        print((refused_as_json if options.format == "json" else annotation)(refused.alarm))
        if refused.alarm.number in ("HT9000", "HT9001"):  # unreadable: no finding, but no use either
            raise
        return ExitCode.FINDING
    if options.trace:
        _print_messages(result)
    elif options.format == "json":
        from twin.cli.check_json import as_json_text  # noqa: PLC0415 - a table for people needs no json

        print(as_json_text(result))
    elif options.format == "github":
        from twin.cli.check_json import as_github  # noqa: PLC0415

        print("".join(f"{line}\n" for line in as_github(result)), end="")
    else:
        print("\n".join(as_text(result)))
    return result.exit_code(strict=options.strict)


def _check_program(options: argparse.Namespace) -> CheckResult:
    target: Path = options.target
    if not target.exists():
        raise InputError("there is no such file", place=Place(file=str(target)))
    setup = options.setup or "hobbing"
    given = given_by(options, setup)
    parameters = delivered(setup, given.parameters)
    machine, program = machine_data(parameters), _program(target)
    found = dry_run(
        program,
        parameters,
        Offsets(),
        given.signals,
        events=given.events,
        observe=_tracer(options, machine, program),
    )
    return _result(options, found, machine, program)


def _program(target: Path) -> Program:
    """A file or a folder of programs."""
    try:
        return load_program(target)
    except AlarmError as cause:
        if target.is_dir() and cause.alarm.number == "HT9001":
            place = Place(file=str(target))
            text = f"neither a job nor a program: no {_JOB}, and no file with an O number"
            raise InputError(text, place=place, remedy=f"valid: {_JOB}, or files such as O0001.nc") from cause
        raise


def _check_job(options: argparse.Namespace) -> CheckResult:
    from twin.advice.dry import advised_run  # noqa: PLC0415 - a bare program needs none of this
    from twin.job import read_job  # noqa: PLC0415
    from twin.presets import cutters_of, settings_of  # noqa: PLC0415

    job = read_job(options.target)
    if options.setup and options.setup != job.machine.setup:
        raise InputError(f"--setup {options.setup}: the job says {job.machine.setup}")
    given = given_by(options, job.machine.setup)
    cutters = cutters_of(job)
    settings = settings_of(
        job, cutters, parameters=given.parameters, signals=given.signals, events=given.events
    )
    machine, program = machine_data(settings.parameters), load_program(job.program)
    observe = _tracer(options, machine, program)
    found, advice = advised_run(job, cutters, settings, program, observe=observe)
    result = _result(options, found, machine, program)
    return CheckResult(run=found, machine=machine, program=program, read_on=result.read_on, advice=advice)


def _result(
    options: argparse.Namespace, found: DryRun, machine: MachineData, program: Program
) -> CheckResult:
    """The result, with what stands behind the first alarm where that is asked for."""
    read_on = ()
    if options.keep_going and found.alarms:
        span = found.alarms[0].span
        line = span.line if span and span.line and span.file == program.file else 0
        read_on = alarms_behind(program, machine.parameters, line)
    return CheckResult(run=found, machine=machine, program=program, read_on=read_on)


def _tracer(options: argparse.Namespace, machine: MachineData, program: Program) -> Observer | None:
    """Prints the trace as it goes; None where none is asked for."""
    if not options.trace:
        return None
    return lambda seen: print(trace_line(seen.command, seen.span, machine, program.file))


def _print_messages(result: CheckResult) -> None:
    """The end of a trace: its alarm belongs to it, what is to be said goes beside it."""
    for alarm in result.run.alarms:
        print(trace_alarm(alarm, result.program.file))
    for message in result.messages:
        print(message, file=sys.stderr)
