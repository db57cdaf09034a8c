"""`make bench`: one JSON line a case. Ratios are taken within one run, so a slow machine does not matter."""

import json
import resource
import time

from benchmarks.inspection import inspection
from benchmarks.machine import machine_stages
from benchmarks.reading import program_of, reading
from controller.dry_run import dry_run
from controller.language.source import parse_program
from controller.tables.parameters import delivered
from twin.benchmark.cases import CASES
from twin.benchmark.kernel import kernel_figures, scaling_figures


def say(**figures: object) -> None:
    figures["peak_mib"] = round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
    print(json.dumps({k: round(v, 4) if isinstance(v, float) else v for k, v in figures.items()}), flush=True)


def controller_blocks(kind: str, blocks: int) -> None:
    """Lexing, interpreting and planning; the peak of memory is that of the process so far."""
    program = parse_program(program_of(kind, blocks), file="bench.nc")
    start = time.perf_counter()
    found = dry_run(program, delivered("hobbing"))
    seconds = time.perf_counter() - start
    say(
        case="check",
        kind=kind,
        blocks=blocks,
        seconds=seconds,
        blocks_per_s=blocks / seconds,
        alarms=len(found.alarms),
    )


for figures in inspection():
    say(**figures)
for figures in reading():
    say(**figures)
controller_blocks("plain", 1_000_000)
for figures in machine_stages():
    say(**figures)
for name in CASES:
    say(**kernel_figures(name))
for figures in scaling_figures():
    say(**figures)
