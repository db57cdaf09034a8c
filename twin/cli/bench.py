"""`hobtwin bench`"""

import argparse
import json

from twin.benchmark.kernel import kernel_figures
from twin.errors import ExitCode


def bench_command(options: argparse.Namespace) -> ExitCode:
    """Time a part of the twin; one JSON line."""
    figures = kernel_figures(options.case)
    print(json.dumps({k: round(v, 6) if isinstance(v, float) else v for k, v in figures.items()}))
    return ExitCode.FINE
