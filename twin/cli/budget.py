"""`hobtwin budget`"""

import argparse
import sys
from pathlib import Path

from twin.budget.draw_up import draw_up
from twin.budget.output import write_budget
from twin.budget.text import lines
from twin.errors import ExitCode
from twin.job import read_job
from twin.output.folder import require_replaceable


def budget_command(options: argparse.Namespace) -> ExitCode:
    """Draw up a job's error budget. Raises HobtwinError and ControllerError."""
    job = read_job(options.job)
    out = options.out or Path("out") / f"{job.name}_budget"
    require_replaceable(out)

    def tell(text: str) -> None:
        if not options.quiet:
            print(text, file=sys.stderr)

    budget = draw_up(job, progress=tell)
    write_budget(out, job, budget)
    for line in lines(budget):
        print(line)
    print(f"budget: {out / 'budget.html'}")
    failed = any(share.reason for share in (*budget.shares, budget.together))
    return ExitCode.FINDING if failed else ExitCode.FINE
