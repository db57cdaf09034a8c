"""`hobtwin compensate`"""

import argparse
import math
from pathlib import Path

from twin.compensation.output import write_compensation
from twin.compensation.text import lines
from twin.compensation.walk import walk
from twin.errors import ExitCode, InputError
from twin.job import read_job
from twin.outcome import Options
from twin.output.folder import result_folder
from twin.progress import shown


def compensate_command(options: argparse.Namespace) -> ExitCode:
    """Probe, fit, compensate, cut both gears. Raises HobtwinError and ControllerError."""
    cell = options.cell_mm
    if cell is not None and not (math.isfinite(cell) and cell > 0):
        raise InputError(f"--cell-mm {cell:g}", remedy="valid: above 0, for example 0.1")
    job = read_job(options.job)
    out = options.out or Path("out") / f"{job.name}_compensated"
    settings = Options(ideal=options.ideal, cell_mm=cell)
    with result_folder(out) as folder, shown(quiet=options.quiet) as reporter:
        found = walk(job, folder, settings, reporter)
        write_compensation(folder, found)
    for line in lines(found):
        print(line)
    print(f"compensated job: {out / 'compensated'}")
    print(f"report: {out / 'compensation.html'}")
    return found.after.outcome.exit_code
