"""Arguments in, exit code out. Commands import what they need when they run: `check` stays light."""

import argparse
import signal
import sys
import threading
from collections.abc import Sequence
from pathlib import Path

from twin.errors import ExitCode, HobtwinError


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command. Returns the exit code of the contract: 0 fine, 1 finding, 2 usage, 3 our fault."""
    options = _parser().parse_args(arguments)
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
    from controller.alarms import AlarmError, ControllerError  # noqa: PLC0415

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

    run = commands.add_parser("run", help="run a job: program, machine, cut, inspection, report")
    run.add_argument("job", type=Path, metavar="JOB", help="a job folder or a job.toml")
    run.add_argument("--out", type=Path, metavar="DIR", help="result folder (default: out/<job name>)")
    run.add_argument("--ideal", action="store_true", help="axes follow their setpoints exactly")
    run.add_argument("--cell-mm", type=float, metavar="MM", help="cell of the cutting grid (default: chosen)")
    run.add_argument(
        "--event",
        action="append",
        default=[],
        metavar="EVENT",
        help='what the operator does: "3.0 feed hold", "line 12 reset"',
    )
    run.add_argument("--chips", action="store_true", help="what each tooth takes away; writes chips.npz")
    run.add_argument("--strict", action="store_true", help="warnings are findings too")
    run.add_argument("--quiet", action="store_true", help="no progress")
    run.set_defaults(command=_run)

    check = commands.add_parser("check", help="check a program without machine and metal")
    check.add_argument("target", type=Path, metavar="JOB_or_PROGRAM")
    check.add_argument("--setup", choices=("hobbing", "tilted"), help="of a bare program (default: hobbing)")
    check.add_argument("--parameter", action="append", default=[], metavar="8200#0=1")
    check.add_argument("--signal", action="append", default=[], metavar="NOZAGC=1")
    check.add_argument(
        "--event",
        action="append",
        default=[],
        metavar="EVENT",
        help='what the operator does: "3.0 feed hold", "line 12 reset"',
    )
    check.add_argument("--keep-going", action="store_true", help="read on behind the first alarm")
    check.add_argument("--trace", action="store_true", help="print the canonical trace")
    check.add_argument("--strict", action="store_true", help="warnings are findings too")
    check.add_argument("--format", choices=("text", "json", "github"), default="text")
    check.set_defaults(command=_check)

    inspect = commands.add_parser("inspect", help="measure a mesh")
    inspect.add_argument("mesh", type=Path, metavar="MESH", help="STL, 3MF, GLB, PLY or OBJ")
    inspect.add_argument(
        "--units",
        choices=("mm", "cm", "m", "um", "inch", "ft"),
        help="of the file (default: what it declares, else mm)",
    )
    inspect.add_argument(
        "--find-axis", action="store_true", help="measure about the bore or tip circle, not about Z"
    )
    inspect.add_argument("--job", type=Path, metavar="JOB", help="take the nominal from a job")
    inspect.add_argument("--teeth", type=int)
    inspect.add_argument("--module", type=float, metavar="MM")
    inspect.add_argument("--helix", type=float, metavar="DEG", help="+ right-hand")
    inspect.add_argument("--profile-shift", type=float, metavar="X")
    inspect.add_argument("--pressure-angle", type=float, metavar="DEG", help="normal (default: 20)")
    inspect.add_argument("--tip-diameter", type=float, metavar="MM")
    inspect.add_argument("--face-width", type=float, metavar="MM")
    inspect.add_argument("--pin-diameter", type=float, metavar="MM", help="of the balls to measure over")
    inspect.add_argument("--class", type=int, dest="accuracy_class", metavar="A", help="ISO 1328-1 class")
    inspect.add_argument(
        "--teeth-to-measure", metavar="1,6,11,16", help="teeth to trace, or all (default: four)"
    )
    inspect.add_argument("--csv", type=Path, metavar="FILE", help="write the points of all traces")
    inspect.add_argument("--sides", type=int)
    inspect.add_argument("--across-flats", type=float, metavar="MM")
    inspect.add_argument("--tolerance", metavar="h13", help="of the width across flats (default: h13)")
    inspect.add_argument("--format", choices=("text", "json"), default="text")
    inspect.set_defaults(command=_inspect)

    explain = commands.add_parser("explain", help="what a code, alarm, parameter, signal or event means")
    explain.add_argument("name", nargs="*", metavar="NAME", help="PS1594, G81, 201#4, NOZAGC, feed hold, …")
    explain.add_argument("--all", action="store_true", help="everything, in full")
    explain.add_argument("--format", choices=("text", "json", "markdown"), default="text")
    explain.set_defaults(command=_explain)
    return parser


def _run(options: argparse.Namespace) -> ExitCode:
    from twin.cli.run import run_command  # noqa: PLC0415

    return run_command(options)


def _check(options: argparse.Namespace) -> ExitCode:
    from twin.cli.check import check_command  # noqa: PLC0415

    return check_command(options)


def _explain(options: argparse.Namespace) -> ExitCode:
    from twin.cli.explain import explain_command  # noqa: PLC0415

    return explain_command(options)


def _inspect(options: argparse.Namespace) -> ExitCode:
    from twin.cli.inspect import inspect_command  # noqa: PLC0415

    return inspect_command(options)
