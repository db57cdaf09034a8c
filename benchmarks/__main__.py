"""`make bench`: one JSON line a case. Ratios are taken within one run, so a slow machine does not matter."""

import json
import math
import resource
import time
from pathlib import Path

import manifold3d
import numpy as np

from benchmarks.reading import program_of, reading
from controller.cnc import Controller
from controller.dry_run import dry_run
from controller.language.source import load_program, parse_program
from controller.tables.parameters import delivered
from twin.cutting.blank import Blank
from twin.cutting.cut import cut
from twin.job import read_job
from twin.machine import IdealMachine, MujocoMachine
from twin.presets import cutters_of, settings_of
from twin.session import record
from twin.setup import make_ready

SCENES = Path(__file__).parents[1] / "scenes"
LOFT_TRIANGLES = 26_400


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


def kernel(scene: str) -> None:
    """The cut of a scene on ideal axes, against one boolean of a blank minus 20 lofts."""
    job = read_job(SCENES / scene)
    cutters = cutters_of(job)
    ready, settings = make_ready(job, cutters), settings_of(job, cutters)
    program = load_program(job.program)
    controller = Controller(program, parameters=settings.parameters, offsets=settings.offsets)
    motions = record(controller, IdealMachine(len(controller.axes)), ready).motions
    blank = Blank(diameter_mm=job.work.diameter_mm, length_mm=job.work.length_mm, bore_mm=job.work.bore_mm)
    start = time.perf_counter()
    result = cut(blank, motions)
    seconds = time.perf_counter() - start
    reference = boolean_of_lofts()
    say(
        case="kernel",
        scene=scene,
        kernel_s=seconds,
        boolean_s=reference,
        kernel_over_boolean=seconds / reference,
        triangles=len(result.remains.faces),
        pairs=result.pairs,
        max_error_um=result.largest_error_um,
    )


def boolean_of_lofts(count: int = 20) -> float:
    """Seconds of one boolean: a blank without `count` wavy prisms of LOFT_TRIANGLES triangles each."""
    around, along = 60, LOFT_TRIANGLES // 120
    angle = np.linspace(0, 2 * math.pi, around, endpoint=False)
    z = np.linspace(-21, 1, along + 1)
    size = 1.2 + 0.01 * np.sin(3 * z)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    lofts = []
    for n in range(count):
        turn = 2 * math.pi * n / count
        middle = 21.5 * np.array([math.cos(turn), math.sin(turn)])
        xy = middle + size[:, None, None] * ring
        points = np.concatenate([xy, np.broadcast_to(z[:, None, None], (along + 1, around, 1))], axis=2)
        vertices = np.concatenate([points.reshape(-1, 3), [[*middle, z[0]], [*middle, z[-1]]]])
        k = np.arange(along)[:, None] * around
        a, b = k + np.arange(around), k + (np.arange(around) + 1) % around
        c, d = a + around, b + around
        last = len(vertices)
        bottom = np.stack([b[0], a[0], np.full(around, last - 2)], axis=1)
        top = np.stack([c[-1], d[-1], np.full(around, last - 1)], axis=1)
        sides = np.concatenate([np.stack([a, b, d], axis=-1), np.stack([a, d, c], axis=-1)]).reshape(-1, 3)
        faces = np.concatenate([sides, bottom, top]).astype(np.uint64)
        lofts.append(manifold3d.Manifold(manifold3d.Mesh64(vertices, faces)))
    blank = Blank(diameter_mm=44.0, length_mm=20.0).solid()
    start = time.perf_counter()
    left = manifold3d.Manifold.batch_boolean([blank, *lofts], manifold3d.OpType.Subtract)
    if left.is_empty():
        raise RuntimeError("the reference boolean left nothing")
    return time.perf_counter() - start


controller_blocks("plain", 100_000)
controller_blocks("mixed", 100_000)
for figures in reading():
    say(**figures)
controller_blocks("plain", 1_000_000)
machine_ticks()
for name in ("hexagon_af17", "spur_m2_z20"):
    kernel(name)
