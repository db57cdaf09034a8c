"""The scene's program sets what the law asks for, gap by gap, before any metal is ground."""

import math
from pathlib import Path

import numpy as np
import pytest

from controller.commands import Move
from controller.dry_run import dry_run
from controller.language.source import load_program
from twin.job import read_job
from twin.presets import cutters_of, settings_of
from twin.probing.circle import Circle
from twin.probing.law import plain_correction

SCENE = Path(__file__).parents[3] / "scenes" / "ground_gear_off_centre"


def test_every_gap_is_met_where_the_law_says():
    job = read_job(SCENE)
    settings = settings_of(job, cutters_of(job))
    at, strokes = {}, []

    def see(seen):
        if isinstance(seen.command, Move):
            at.update(seen.command.absolute)
            if seen.command.feed:
                strokes.append((at[3], at[0], at[2]))

    found = dry_run(
        load_program(job.program), settings.parameters, settings.offsets, settings.signals, observe=see
    )
    assert found.alarms == ()
    c, x, y = np.array(strokes).T
    e, phase = job.faults.work_eccentricity_mm, math.radians(job.faults.work_eccentricity_phase_deg)
    gaps = np.radians(job.work.gear.gap_phase_deg + 12.0 * np.arange(30))
    law = plain_correction(Circle(x=e * math.cos(phase), y=e * math.sin(phase), radius=38.0), gaps)
    assert np.exp(1j * np.radians(c)) == pytest.approx(np.exp(1j * law.c), abs=1e-9)
    # the control cuts off what is finer than 0.001 mm, in diameter for X
    assert y == pytest.approx(law.y, abs=1.01e-3)
    assert x - 41.25 == pytest.approx(law.x, abs=0.51e-3)
    assert np.ptp(law.y) > 0.099
