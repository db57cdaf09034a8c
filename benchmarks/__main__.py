"""`make bench`: one JSON line a case. Ratios are taken within one run, so a slow machine does not matter."""

import json
import resource
import time
from pathlib import Path

from benchmarks.inspection import inspection
from benchmarks.reading import program_of, reading
from controller.cnc import Controller
from controller.dry_run import dry_run
from controller.language.source import load_program, parse_program
from controller.tables.parameters import delivered
from twin.benchmark.cases import CASES
from twin.benchmark.kernel import kernel_figures, scaling_figures
from twin.job import read_job
from twin.machine import IdealMachine, MujocoMachine
from twin.presets import cutters_of, settings_of
from twin.session import record
from twin.setup import make_ready

SCENES = Path(__file__).parents[1] / "scenes"


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


def machine_ticks(scene: str = "hexagon_af17") -> None:
    """Control ticks of the physical machine, against machine time."""
    job = read_job(SCENES / scene)
    cutters = cutters_of(job)
    ready, settings = make_ready(job, cutters), settings_of(job, cutters)
    program = load_program(job.program)
    for name, machine in (
        ("ideal", IdealMachine(len(ready.tools[0].assembly.joints))),
        ("mujoco", MujocoMachine(ready.tools[0].assembly)),
    ):
        controller = Controller(program, parameters=settings.parameters, offsets=settings.offsets)
        start = time.perf_counter()
        ticks = len(record(controller, machine, ready).recording.time_s)
        seconds = time.perf_counter() - start
        say(
            case=f"run {name}",
            scene=scene,
            ticks_per_s=ticks / seconds,
            times_real_time=ticks / 1000 / seconds,
        )


for figures in inspection():
    say(**figures)
for figures in reading():
    say(**figures)
controller_blocks("plain", 1_000_000)
machine_ticks()
for name in CASES:
    say(**kernel_figures(name))
for figures in scaling_figures():
    say(**figures)
