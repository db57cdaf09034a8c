"""The whole walk: probe, fit, compensated program, both gears cut and measured."""

import math
import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from controller.language.source import load_program
from controller.tables.machine_data import machine_data
from twin.advice.dry import advised_run
from twin.compensation.measure import Measurement, measure
from twin.compensation.removal import Removal, removal
from twin.compensation.rewrite import Rewritten, across, rewritten
from twin.errors import HobtwinError, InputError, Place
from twin.inspection.involute import Involute, geometry
from twin.inspection.nominal import GearNominal
from twin.job.locate import line_of
from twin.job.schema import Job
from twin.outcome import Options, Outcome
from twin.presets import cutters_of, settings_of
from twin.probing.band import steps_of
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
    has_y: bool
    gaps_deg: tuple[float, ...]
    """direction of every gap from the part's +X"""
    corrections: GapCorrection
    """of every gap: C, X, Y, and the slope that stays without a Y axis (beta)"""
    rewritten: Rewritten
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
    has_y = across(machine_data(settings.parameters))
    radius = gear.measuring_diameter / 2.0
    title = f"COMPENSATED FOR E {circle.eccentricity:.4f} MM AT {_degrees(circle.phase):.2f} DEG"
    cutters = cutters_of(job)
    program = rewritten(
        load_program(job.program),
        settings,
        circle,
        work=make_ready(job, cutters).work_column,
        radius=radius,
        title=title,
    )
    compensated = write_job(job, program.text, folder / "compensated")
    dry, _ = advised_run(compensated, cutters, settings, load_program(compensated.program))
    if dry.alarms:
        raise HobtwinError(f"the compensated program ends in an alarm: {dry.alarms[0]}")
    gaps = _gaps(job, gear)
    law = (
        plain_correction(circle, np.radians(gaps))
        if has_y
        else turned_correction(circle, np.radians(gaps), radius)
    )
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
        has_y=has_y,
        gaps_deg=tuple(gaps.tolist()),
        corrections=law,
        rewritten=program,
        before=before,
        after=after,
    )


def write_job(job: Job, program: str, folder: Path) -> Job:
    """A copy of the job in a folder of its own, with another program. Raises InputError where the job file
    does not name its program in a way that can be replaced."""
    text = job.path.read_text(encoding="utf-8")
    lines = text.splitlines()
    _replace(job, lines, ("program", "file"), PROGRAM)
    if "/" in job.machine.model:
        _replace(job, lines, ("machine", "model"), str(job.model_folder.resolve()))
    folder.mkdir(parents=True)
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
