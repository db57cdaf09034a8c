"""A probing cycle run on the machine of the probed scene, with changes, shared by the tests of touches."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from controller.language.source import load_program
from twin.job import read_job
from twin.presets import cutters_of, settings_of
from twin.session import Session, run_program
from twin.setup import make_ready

SCENE = Path(__file__).parents[3] / "scenes" / "ground_spur_probed"
JOB = read_job(SCENE)
PERFECT = {"repeatability_um": 0.0, "latency_s": 0.0}
BAND_RADIUS = 39.0


def job_with(faults=None, **probe):
    return replace(JOB, probe=replace(JOB.probe, **probe), faults=replace(JOB.faults, **(faults or {})))


def cycle(folder: Path, *lines: str) -> Path:
    """A program beside the scene's macro."""
    (folder / "O9810.nc").write_text((SCENE / "O9810.nc").read_text())
    path = folder / "cycle.nc"
    start = ("O0002", "G28 V0", "G28 U0 W0", "G28 H0", "G54 G98 G00 T0909")
    path.write_text("\n".join((*start, *lines, "M30", "")))
    return path


def probed(job, program: Path, *, ideal: bool) -> Session:
    cutters = cutters_of(job)
    settings = settings_of(job, cutters)
    ready = make_ready(job, cutters, lowest_z_mm=-120.0)
    return run_program(load_program(program), settings, ready, ideal=ideal)


def touches(session: Session) -> tuple[np.ndarray, np.ndarray]:
    """Radii [mm] and angles of C [rad] of the touches."""
    n = range(1, int(session.common[501]) + 1)
    return (
        np.array([session.common[600 + k] for k in n]),
        np.radians([session.common[700 + k] for k in n]),
    )


def law(job, c: np.ndarray) -> np.ndarray:
    """Where the front of the ball stands when the signal comes: x = e_x + √((R + ρ)² − e_y²), less ρ and the
    pre-travel (no tilt)."""
    e, phase = job.faults.work_eccentricity_mm, np.radians(job.faults.work_eccentricity_phase_deg) + c
    rho = job.probe.ball_radius_mm
    reach = np.sqrt((BAND_RADIUS + rho) ** 2 - (e * np.sin(phase)) ** 2)
    return e * np.cos(phase) + reach - rho - job.probe.pretravel_mm
