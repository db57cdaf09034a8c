"""`hobtwin bench`"""

import argparse
import json

from twin.benchmark.kernel import kernel_figures
from twin.errors import ExitCode
from twin.progress import shown


def bench_command(options: argparse.Namespace) -> ExitCode:
    """Time a part of the twin; one JSON line."""
    with shown() as reporter:
        figures = kernel_figures(options.case, reporter)
    print(json.dumps({k: round(v, 6) if isinstance(v, float) else v for k, v in figures.items()}))
    return ExitCode.FINE
