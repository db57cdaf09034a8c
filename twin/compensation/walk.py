"""The whole walk: probe, fit, compensated program, both gears cut and measured."""

import math
import re
import shutil
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from controller.language.source import load_program
from controller.tables.machine_data import machine_data
from twin.advice.dry import advised_run
from twin.compensation.correction import Way
from twin.compensation.hobbing import first_gear_box, with_table
from twin.compensation.measure import Measurement, measure
from twin.compensation.removal import Removal, removal
from twin.compensation.rewrite import across, rewritten
from twin.errors import HobtwinError, InputError, Place
from twin.inspection.involute import Involute, geometry
from twin.inspection.nominal import GearNominal
from twin.job.locate import line_of
from twin.job.schema import Job
from twin.outcome import Options, Outcome
from twin.presets import ControllerSettings, cutters_of, settings_of
from twin.probing.band import steps_of
from twin.probing.circle import Circle
from twin.probing.law import GapCorrection, plain_correction, require_inside, turned_correction
from twin.progress import Reporter
from twin.run import run_job
from twin.setup import make_ready

Floats = NDArray[np.float64]

PROGRAM = "compensated.nc"


@dataclass(frozen=True, slots=True, kw_only=True)
class Stage:
    """One of the two gears."""

    outcome: Outcome
    removal: Removal | None
    """where the blank was cut before"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Compensation:
    """All that the walk has found."""

    job: Job
    gear: Involute
    measurement: Measurement
    way: Way
    gaps_deg: tuple[float, ...]
    """direction of every gap from the part's +X"""
    corrections: GapCorrection
    """of every gap: C, X, Y, and the slope that stays without a Y axis (beta)"""
    before: Stage
    after: Stage


def walk(job: Job, folder: Path, options: Options, reporter: Reporter) -> Compensation:
    """Walk a job through, writing into `folder`: the compensated job in `compensated/`, both results in
    `before/` and `after/`.

    Raises HobtwinError where the job cannot be compensated; ProbingError for what the probe has found.
    """
    nominal = job.nominal
    if not isinstance(nominal, GearNominal):
        raise InputError(
            "a job without a nominal gear", place=Place(file=str(job.path)), remedy='[nominal] kind = "gear"'
        )
    gear = geometry(nominal)
    reporter.stage("probing")
    found = measure(job, ideal=options.ideal)
    circle = found.centre.geometric
    require_inside(circle, gear.root_diameter / 2.0)
    settings = settings_of(job, cutters_of(job), events=options.events)
    title = f"COMPENSATED FOR E {circle.eccentricity:.4f} MM AT {_degrees(circle.phase):.2f} DEG"
    way, text = _compensated(job, settings, circle, gear, title)
    compensated = write_job(job, text, folder / "compensated")
    dry, _ = advised_run(compensated, cutters_of(job), settings, load_program(compensated.program))
    if dry.alarms:
        raise HobtwinError(f"the compensated program ends in an alarm: {dry.alarms[0]}")
    gaps = _gaps(job, gear)
    stages = []
    for name, one in (("before", job), ("after", compensated)):
        reporter.stage(f"{name} compensation")
        outcome = run_job(one, folder / name, options, reporter)
        stages.append(Stage(outcome=outcome, removal=_removal(job, outcome)))
    before, after = stages
    return Compensation(
        job=job,
        gear=gear,
        measurement=found,
        way=way,
        gaps_deg=tuple(gaps.tolist()),
        corrections=_law(way, circle, gear, np.radians(gaps)),
        before=before,
        after=after,
    )


def _compensated(
    job: Job, settings: ControllerSettings, circle: Circle, gear: Involute, title: str
) -> tuple[Way, str]:
    """How the job's program is compensated, and the program."""
    program = load_program(job.program)
    engaged = first_gear_box(program, settings)
    if engaged is not None:
        radius = gear.reference_diameter / 2.0
        return Way.TABLE, with_table(program, engaged, circle, radius=radius, title=title)
    way = Way.ACROSS if across(machine_data(settings.parameters)) else Way.TURNED
    written = rewritten(
        program,
        settings,
        circle,
        work=make_ready(job, cutters_of(job)).work_column,
        radius=gear.measuring_diameter / 2.0,
        title=title,
    )
    return way, written


def _law(way: Way, circle: Circle, gear: Involute, gaps: Floats) -> GapCorrection:
    """What every gap, at its direction (z,) [rad], is corrected by."""
    plain = plain_correction(circle, gaps)
    if way is Way.ACROSS:
        return plain
    if way is Way.TURNED:
        return turned_correction(circle, gaps, gear.measuring_diameter / 2.0)
    radius = gear.reference_diameter / 2.0
    return replace(plain, c=plain.c - plain.y / radius, y=np.zeros_like(plain.y))


def write_job(job: Job, program: str, folder: Path) -> Job:
    """A copy of the job in a folder of its own, with another program, and with what stood beside the old one.

    Raises InputError where the job file does not name its program in a way that can be replaced.
    """
    text = job.path.read_text(encoding="utf-8")
    lines = text.splitlines()
    _replace(job, lines, ("program", "file"), PROGRAM)
    if "/" in job.machine.model:
        _replace(job, lines, ("machine", "model"), str(job.model_folder.resolve()))
    folder.mkdir(parents=True)
    for path in sorted(job.path.parent.glob(f"*{job.program.suffix}")):
        if path.is_file() and path.name not in (job.program.name, PROGRAM):
            shutil.copy(path, folder / path.name)
    (folder / PROGRAM).write_text(program, encoding="utf-8")
    path = folder / "job.toml"
    path.write_text("\n".join([*lines, ""]), encoding="utf-8")
    return replace(job, name=f"{job.name}_compensated", path=path, program=folder / PROGRAM)


def _replace(job: Job, lines: list[str], key: tuple[str, str], value: str) -> None:
    """Put another string in the place of a key's."""
    number = line_of("\n".join(lines), key)
    pattern = rf"""(\b{key[1]}\s*=\s*)("[^"]*"|'[^']*')"""
    if number is None or not re.search(pattern, lines[number - 1]):
        raise InputError(
            f"{'.'.join(key)} of the job is not written in one line",
            place=job.place(*key),
            remedy=f'{key[1]} = "…" in [{key[0]}]',
        )
    lines[number - 1] = re.sub(pattern, lambda found: f'{found[1]}"{value}"', lines[number - 1], count=1)


def _gaps(job: Job, gear: Involute) -> Floats:
    """(z,) directions of the gaps [deg]."""
    first = job.work.gear.gap_phase_deg if job.work.gear else 0.0
    return first + 360.0 * np.arange(gear.teeth) / gear.teeth


def _removal(job: Job, outcome: Outcome) -> Removal | None:
    if job.work.gear is None:
        return None
    blank = job.work.blank()
    toothed = [step for step in steps_of(blank) if not step.band]
    return removal(
        outcome.cut.remains.vertices,
        job.work.gear,
        low=min(step.low for step in toothed),
        high=max(step.high for step in toothed),
    )


def _degrees(angle: float) -> float:
    return math.degrees(angle) % 360.0
