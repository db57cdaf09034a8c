"""How fast the machine stage of a run is, against a bare loop of physics steps on the same joints.

CPU seconds of all threads; the ratio to the bare loop, of the same run, does not depend on the computer.
"""

# pyright: reportAttributeAccessIssue=false

import time
from collections.abc import Iterator
from pathlib import Path

import mujoco  # its bindings are compiled and carry no types

from controller.language.source import load_program
from twin.advice.dry import advised_run
from twin.job import read_job
from twin.presets import cutters_of, settings_of
from twin.run import lowest_z
from twin.session import run_program
from twin.setup import Ready, make_ready

SCENES = Path(__file__).parents[1] / "scenes"
STEPS, TIMES = 5000, 5


def bare_step_s(ready: Ready) -> float:
    """CPU time of one physics step of a scene's machine, the least of some loops."""
    model = ready.driven.joints_alone
    data, seconds = mujoco.MjData(model), []
    for _ in range(TIMES):
        start = time.process_time()
        for _ in range(STEPS):
            mujoco.mj_step(model, data)
        seconds.append(time.process_time() - start)
    return min(seconds) / STEPS


def machine_stages() -> Iterator[dict[str, object]]:
    """Two results a scene: with physics, and with ideal axes."""
    for folder in sorted(SCENES.iterdir()):
        job = read_job(folder)
        cutters = cutters_of(job)
        settings, program = settings_of(job, cutters), load_program(job.program)
        foreseen, _ = advised_run(job, cutters, settings, program)
        ready = make_ready(job, cutters, lowest_z_mm=lowest_z(job, foreseen))
        for ideal in (False, True):
            start = time.process_time()
            session = run_program(program, settings, ready, ideal=ideal)
            seconds = time.process_time() - start
            ticks = len(session.recording.time_s)
            figures = {
                "case": "machine ideal" if ideal else "machine",
                "scene": folder.name,
                "ticks": ticks,
                "seconds": seconds,
                "ticks_per_s": ticks / seconds,
                "times_real_time": ticks * ready.spec.control_period_s / seconds,
            }
            if not ideal:
                steps = ticks * ready.spec.substeps * bare_step_s(ready)
                figures |= {"times_bare_steps": seconds / steps}
            yield figures
