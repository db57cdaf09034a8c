"""`hobtwin run`"""

import argparse
import math
from pathlib import Path

from twin.cli.given import events_of_options
from twin.errors import ExitCode, InputError
from twin.job import read_job
from twin.outcome import Options, Outcome
from twin.progress import shown
from twin.run import run_job
from twin.terminal import lines


def run_command(options: argparse.Namespace) -> ExitCode:
    """Run a job and say what came out. Raises HobtwinError and ControllerError."""
    cell = options.cell_mm
    if cell is not None and not (math.isfinite(cell) and cell > 0):
        raise InputError(f"--cell-mm {cell:g}", remedy="valid: above 0, for example 0.1")
    tolerance = options.tolerance_um
    if not (math.isfinite(tolerance) and tolerance > 0):
        raise InputError(f"--tolerance-um {tolerance:g}", remedy="valid: above 0, for example 1")
    job = read_job(options.job)
    out = options.out or Path("out") / job.name
    settings = Options(
        ideal=options.ideal,
        cell_mm=cell,
        tolerance_um=tolerance,
        chips=options.chips,
        events=events_of_options(options),
    )
    with shown(quiet=options.quiet) as reporter:
        outcome = run_job(job, out, settings, reporter)
    for line in lines(outcome):
        print(line)
    print(f"report: {out / 'report.html'}")
    return _code(outcome, strict=options.strict)


def _code(outcome: Outcome, *, strict: bool) -> ExitCode:
    warned = any(advice.warns for advice in outcome.advice)
    if strict and (outcome.session.warnings or warned or outcome.cut.notes):
        return ExitCode.FINDING
    return outcome.exit_code
