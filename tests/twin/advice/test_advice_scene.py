"""Where the adviser thinks the tool is, against the compiled machine; arcs; and what two tools make of it."""

from pathlib import Path

import numpy as np
import pytest

from controller.commands import Arc, Feed
from controller.observed import Observed
from controller.span import Span
from controller.tables.machine_data import machine_data
from twin.advice.paths import path_of
from twin.advice.scene import scene_of
from twin.job import read_job
from twin.presets import cutters_of, settings_of
from twin.setup import make_ready

SCENES = Path(__file__).parents[3] / "scenes"


def scene_in(folder: Path):
    job = read_job(folder)
    cutters = cutters_of(job)
    settings = settings_of(job, cutters)
    return job, cutters, scene_of(job, cutters, machine_data(settings.parameters))


@pytest.mark.parametrize("setup", ["hobbing", "tilted"])
@pytest.mark.parametrize("name", ["hexagon_af17", "helical_m2_z20_right"])
def test_the_centre_of_the_tool_is_that_of_the_compiled_machine(tmp_path, setup, name):
    """Rulings, section 0: machine zero at X +400, Z +300; the slant unit vector is (sin θ, cos θ)."""
    text = (SCENES / name / "job.toml").read_text(encoding="utf-8")
    (tmp_path / "job.toml").write_text(
        text.replace('setup = "hobbing"', f'setup = "{setup}"'), encoding="utf-8"
    )
    (tmp_path / "program.nc").write_text("M30\n", encoding="utf-8")
    job, cutters, scene = scene_in(tmp_path)
    kinematics = make_ready(job, cutters).tools[0].kinematics
    rng = np.random.default_rng(7)
    axes = rng.uniform(-150.0, 150.0, size=(20, kinematics.axes))
    tool, _ = kinematics.tool.pose(axes)
    work, _ = kinematics.work.pose(axes)
    for row, expected in zip(axes.tolist(), tool - work, strict=True):
        centre = scene.centre(tuple(row))
        assert (centre.x, centre.y, centre.z) == pytest.approx(tuple(expected), abs=1e-9)


@pytest.mark.parametrize(
    ("clockwise", "centre", "end", "middle"),
    [
        # Z X plane, from (Z 0, X 50): a quarter circle of 10 mm about (Z −10, X 50)
        (False, (-10.0, 0.0), (-10.0, 10.0), 45.0),
        (True, (-10.0, 0.0), (-10.0, -10.0), -45.0),
        (True, (-10.0, 0.0), (-10.0, 10.0), -135.0),
    ],
)
def test_points_of_an_arc_lie_on_its_circle_and_go_its_way(clockwise, centre, end, middle):
    """G18: angles count from Z to X; G02 turns back."""
    _, _, scene = scene_in(SCENES / "hexagon_af17")
    start = (-190.0, -300.0, 0.0, 0.0)  # distance 50 of the head of 40 at X 10 in radius, Z 0
    after = (start[0] + end[1], start[1] + end[0], 0.0, 0.0)
    arc = Arc(
        absolute={},
        incremental={1: end[0], 0: end[1]},
        plane=(1, 0),
        centre=centre,
        clockwise=clockwise,
        feed=Feed(value=1.0),
        places={},
    )
    seen = Observed(
        command=arc,
        span=Span(file="program.nc", line=1),
        start_s=0.0,
        end_s=1.0,
        absolute_before=start,
        absolute_after=after,
        slides_before=start,
        slides_after=after,
        gear=None,
        master_rpm=0.0,
    )
    path = path_of(scene, seen, scene.tools[0].envelope)
    around = np.stack([path.axial + 10.0, path.distance - 50.0])
    assert np.abs(np.hypot(*around) - 10.0).max() < 1e-9
    assert (path.axial[-1], path.distance[-1]) == pytest.approx((end[0], 50.0 + end[1]), abs=1e-9)
    halfway = around[:, len(path.axial) // 2] / 10.0
    expected = (np.cos(np.radians(middle)), np.sin(np.radians(middle)))
    assert halfway == pytest.approx(expected, abs=0.05)
