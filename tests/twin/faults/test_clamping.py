"""A blank clamped off the spindle's axis and askew: its senses, and what each datum shows of it."""

import math
import shutil
from pathlib import Path

import numpy as np
import pytest

from twin.faults.mounts import clamping
from twin.faults.table import Faults
from twin.job import read_job
from twin.outcome import Options
from twin.run import run_job

SCENE = Path(__file__).parents[3] / "scenes" / "hexagon_af17"


def test_the_blanks_axis_stands_off_by_the_eccentricity_at_mid_length():
    faults = Faults(
        work_eccentricity_mm=0.05,
        work_eccentricity_phase_deg=30.0,
        work_tilt_deg=0.2,
        work_tilt_phase_deg=110.0,
    )
    mount = clamping(faults, 20.0)
    middle, front = mount.moved(np.array([[0.0, 0.0, -10.0], [0.0, 0.0, 0.0]]))
    np.testing.assert_allclose(middle, [0.05 * math.sqrt(0.75), 0.025, -10.0], atol=1e-12)
    # the front end leans to 110°
    lean = 10.0 * math.sin(math.radians(0.2))
    np.testing.assert_allclose(
        (front - middle)[:2], lean * np.array([math.cos(math.radians(110)), math.sin(math.radians(110))])
    )
    np.testing.assert_allclose(mount.rotation @ mount.rotation.T, np.eye(3), atol=1e-14)


def test_without_fault_nothing_is_moved():
    points = np.array([[1.0, 2.0, 3.0], [-4.0, 0.5, -20.0]])
    np.testing.assert_array_equal(clamping(Faults(), 20.0).moved(points), points)


@pytest.mark.parametrize(("datum", "offset"), [("band", 0.05), ("spindle", 0.0), ("fit", 0.0)])
def test_a_hexagon_is_off_centre_from_the_datum_that_was_clamped_off_centre(tmp_path, datum, offset):
    """What is cut stands about the spindle's axis, at −e in the part's frame."""
    job = tmp_path / "job"
    shutil.copytree(SCENE, job)
    with (job / "job.toml").open("a", encoding="utf-8") as file:
        file.write("[faults]\nwork_eccentricity_mm = 0.05\nwork_eccentricity_phase_deg = 40.0\n")
        file.write(f'[inspection]\ndatum = "{datum}"\n')
    outcome = run_job(read_job(job), tmp_path / "out", Options(ideal=True, cell_mm=0.6))
    polygon = outcome.inspection.polygon
    assert polygon is not None
    assert polygon.concentricity_um == pytest.approx(2e3 * offset, abs=0.2)
    # the middle of a bowed face leans a little where it is off centre; all faces together do not
    found = np.array([face.direction_deg for face in polygon.faces])
    direction = np.radians(found.mean() + 60.0 * np.arange(-2.5, 3.0))
    distance = np.array([face.distance_mm for face in polygon.faces])
    centre = 2.0 * np.array([(distance * np.cos(direction)).mean(), (distance * np.sin(direction)).mean()])
    towards = np.array([math.cos(math.radians(40.0)), math.sin(math.radians(40.0))])
    np.testing.assert_allclose(centre, -offset * towards, atol=1e-4)
    axis = outcome.inspection.axis
    assert (axis is not None) == (datum == "fit")
    if axis is not None:
        np.testing.assert_allclose([axis.x_mm, axis.y_mm], -0.05 * towards, atol=1e-4)
