"""The probing cycle of a job, run on its machine, and the circle through what it touched."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from controller.language.source import load_program
from twin.errors import InputError, Place
from twin.job.schema import Job
from twin.presets import cutters_of, settings_of
from twin.probing.centre import Centre, find_centre
from twin.probing.circle import Circle, touched_points
from twin.probing.errors import ProbingError
from twin.probing.probe import Probe
from twin.session import run_program
from twin.setup import make_ready

Floats = NDArray[np.float64]

TOUCHES, LAST = 501, 502
"""common variables of the cycle: how many touches, X of the last one"""
MACRO_X, MACRO_Y, MACRO_RADIUS = 511, 512, 513
RADIUS, ANGLE = 600, 700
"""#600 + i, #700 + i: radius and angle of C of touch i, from 1"""
MOST = 99


@dataclass(frozen=True, slots=True, kw_only=True)
class Measurement:
    """What the probing cycle has found."""

    radius_mm: Floats
    """(n,) L_i, front of the ball from the work axis"""
    angle_deg: Floats
    """(n,) C"""
    centre: Centre
    macro: Circle | None
    """what the cycle itself has fitted, by the patent's formulas; None where it has fitted nothing"""
    time_s: float
    """of the cycle"""


def measure(job: Job, *, ideal: bool) -> Measurement:
    """Run the job's probing cycle and fit its touches.

    Raises InputError for a job without probe or cycle, ProbingError where the cycle ends in an alarm or its
    touches make no circle that may be compensated.
    """
    probe, program = _cycle(job)
    cutters = cutters_of(job)
    settings = settings_of(job, cutters)
    ready = make_ready(job, cutters)
    session = run_program(load_program(program), settings, ready, ideal=ideal)
    common = session.common
    if session.alarms:
        said = "; ".join(str(alarm) for alarm in session.alarms)
        raise ProbingError(f"the probing cycle ended in an alarm: {said}", remedy=_figures(common))
    radius, angle = _touches(common, program)
    points = touched_points(radius, np.radians(angle))
    centre = find_centre(points, repeatability_mm=probe.repeatability_um * 1e-3)
    x, y, r = (common.get(k) for k in (MACRO_X, MACRO_Y, MACRO_RADIUS))
    macro = None if x is None or y is None or r is None else Circle(x=x, y=y, radius=r)
    time_s = float(session.recording.time_s[-1])
    return Measurement(radius_mm=radius, angle_deg=angle, centre=centre, macro=macro, time_s=time_s)


def _cycle(job: Job) -> tuple[Probe, Path]:
    place = Place(file=str(job.path))
    if job.probe is None:
        raise InputError("the job has no touch probe", place=place, remedy="[probe] with program = …")
    if job.probe.program is None:
        raise InputError(
            "the job names no probing cycle", place=job.place("probe"), remedy='program = "probing.nc"'
        )
    program = job.path.parent / job.probe.program
    if not program.is_file():
        raise InputError(
            f"there is no probing cycle {job.probe.program!r} beside the job",
            place=job.place("probe", "program"),
        )
    return job.probe, program


def _touches(common: Mapping[int, float | None], program: Path) -> tuple[Floats, Floats]:
    """Radii [mm] and angles [deg] of the touches that the cycle has left in its variables."""
    count = common.get(TOUCHES)
    if count is None or count != math.floor(count) or not 0 <= count <= MOST:
        raise ProbingError(
            f"the probing cycle left #{TOUCHES} = {_shown(count)}",
            place=Place(file=str(program)),
            remedy=f"the number of touches, 0 to {MOST}",
        )
    numbers = range(1, int(count) + 1)
    rows = [(common.get(RADIUS + k), common.get(ANGLE + k)) for k in numbers]
    for k, (radius, angle) in zip(numbers, rows, strict=True):
        if radius is None or angle is None:
            raise ProbingError(
                f"the probing cycle left touch {k} empty: #{RADIUS + k} = {_shown(radius)}, "
                f"#{ANGLE + k} = {_shown(angle)}",
                place=Place(file=str(program)),
                remedy="radius and angle of every touch",
            )
    table = np.array(rows, dtype=np.float64).reshape(-1, 2)
    return table[:, 0], table[:, 1]


def _figures(common: Mapping[int, float | None]) -> str:
    """Where the cycle stood when it gave up."""
    names = {TOUCHES: "touches made", LAST: "last X, radius"}
    said = [f"{words} {_shown(common.get(k))}" for k, words in names.items() if k in common]
    return ", ".join(said) or "nothing was touched"


def _shown(value: float | None) -> str:
    return "null" if value is None else f"{value:.10g}"
