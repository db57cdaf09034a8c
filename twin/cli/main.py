"""Arguments in, exit code out. Commands import what they need when they run: `check` stays light."""

import argparse
import os
import signal
import sys
import threading
from collections.abc import Sequence

from twin.cli.arguments import (
    add_bench,
    add_budget,
    add_check,
    add_compensate,
    add_explain,
    add_inspect,
    add_machine,
    add_new,
    add_run,
)
from twin.errors import ExitCode, HobtwinError


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command. Returns the exit code of the contract: 0 fine, 1 finding, 2 usage, 3 our fault."""
    options = _parser().parse_args(arguments)
    for name, value in QUIETER.items():
        os.environ.setdefault(name, value)
    if threading.current_thread() is threading.main_thread():
        # a run that is told to stop cleans up after itself, as with Ctrl-C
        signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        return int(options.command(options))
    except KeyboardInterrupt:
        print("interrupted; nothing was written", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:
        return int(ExitCode.FINE)
    except Exception as error:
        if options.debug:
            raise
        print(_said(error), file=sys.stderr)
        return int(_code(error))


def _code(error: Exception) -> ExitCode:
    from controller.tables.alarms import AlarmError, ControllerError  # noqa: PLC0415

    if isinstance(error, HobtwinError):
        return error.exit_code
    if isinstance(error, AlarmError) and error.alarm.number not in UNREADABLE:
        return ExitCode.FINDING
    return ExitCode.USAGE if isinstance(error, ControllerError) else ExitCode.FAULT


def _said(error: Exception) -> str:
    if _code(error) is not ExitCode.FAULT:
        return str(error)
    what = f"{type(error).__name__}: {error}"
    return f"hobtwin: internal fault: {what} (run again with --debug for the trace)"


QUIETER = {
    "MUJOCO_GL": "disable",  # no window is opened: MuJoCo need not look for what would open one
    "OPENBLAS_NUM_THREADS": "1",  # matrices are small, and we divide the work among threads ourselves
}
"""What libraries are told before they are loaded, if nobody told them otherwise."""
INTERRUPTED = 130
"""Exit code after Ctrl-C, as shells expect it."""
UNREADABLE = frozenset({"HT9000", "HT9001"})
"""Alarms that mean unreadable input rather than a finding in a program."""


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="hobtwin",
        description="Run an NC program on an emulated hobbing lathe, cut the part, inspect it.",
        epilog="exit codes: 0 fine, 1 a finding, 2 usage or unreadable input, 3 a fault of hobtwin",
    )
    parser.add_argument("--debug", action="store_true", help="show the trace of an internal fault")
    commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")

    for add, command in (
        (add_run, _run),
        (add_check, _check),
        (add_inspect, _inspect),
        (add_explain, _explain),
        (add_new, _new),
        (add_budget, _budget),
        (add_compensate, _compensate),
        (add_machine, _machine),
        (add_bench, _bench),
    ):
        add(commands).set_defaults(command=command)
    return parser


def _run(options: argparse.Namespace) -> ExitCode:
    from twin.cli.run import run_command  # noqa: PLC0415

    return run_command(options)


def _budget(options: argparse.Namespace) -> ExitCode:
    from twin.cli.budget import budget_command  # noqa: PLC0415

    return budget_command(options)


def _check(options: argparse.Namespace) -> ExitCode:
    from twin.cli.check import check_command  # noqa: PLC0415

    return check_command(options)


def _explain(options: argparse.Namespace) -> ExitCode:
    from twin.cli.explain import explain_command  # noqa: PLC0415

    return explain_command(options)


def _new(options: argparse.Namespace) -> ExitCode:
    from twin.cli.new import new_command  # noqa: PLC0415

    return new_command(options)


def _inspect(options: argparse.Namespace) -> ExitCode:
    from twin.inspection.beside import Beside  # noqa: PLC0415
    from twin.inspection.mesh_files import read_mesh  # noqa: PLC0415

    mesh = Beside(lambda: read_mesh(options.mesh, options.units))  # while all the rest is loaded
    from twin.cli.inspect import inspect_command  # noqa: PLC0415

    return inspect_command(options, mesh)


def _compensate(options: argparse.Namespace) -> ExitCode:
    from twin.cli.compensate import compensate_command  # noqa: PLC0415

    return compensate_command(options)


def _machine(options: argparse.Namespace) -> ExitCode:
    from twin.cli.machine import machine_command  # noqa: PLC0415

    return machine_command(options)


def _bench(options: argparse.Namespace) -> ExitCode:
    from twin.cli.bench import bench_command  # noqa: PLC0415

    return bench_command(options)
