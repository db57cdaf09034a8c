"""Touches of a clamped blank, through program and controller, against the closed form of their contact."""

import math
from dataclasses import replace

import numpy as np
import pytest
from touching import BAND_RADIUS, PERFECT, SCENE, cycle, job_with, law, probed, touches

from twin.probing.centre import find_centre
from twin.probing.circle import patent_circle, touched_points

CYCLE = ("G00 X140. Z-6.", "G65 P9810 A8. D78. Q0.3 R0.3 F60.", "G00 X140.")
TRUE = 0.05 * np.array([math.cos(math.radians(70.0)), math.sin(math.radians(70.0))])


@pytest.fixture(scope="module")
def servo(tmp_path_factory):
    return probed(job_with(**PERFECT), cycle(tmp_path_factory.mktemp("servo"), *CYCLE), ideal=False)


@pytest.fixture(scope="module")
def ideal(tmp_path_factory):
    return probed(job_with(**PERFECT), cycle(tmp_path_factory.mktemp("ideal"), *CYCLE), ideal=True)


def test_ideal_axes_touch_where_the_closed_form_says(ideal):
    assert ideal.alarms == ()
    radius, c = touches(ideal)
    assert radius == pytest.approx(law(job_with(**PERFECT), c), abs=1e-9)
    found = find_centre(touched_points(radius, c)).geometric
    assert (found.x, found.y) == pytest.approx(tuple(TRUE), abs=1e-8)


def test_the_contact_of_the_physics_model_agrees(servo):
    """The contact gives way by 0.07 µm, alike all around; what is left are counts of the encoder, 0.01 µm."""
    assert servo.alarms == ()
    radius, c = touches(servo)
    off = radius - law(job_with(**PERFECT), c)
    assert -0.15e-3 < off.mean() < 0.0
    assert np.ptp(off) < 0.03e-3
    found = find_centre(touched_points(radius, c)).geometric
    assert (found.x, found.y) == pytest.approx(tuple(TRUE), abs=0.01e-3)


def test_the_macro_fits_as_the_patent_does(servo):
    points = touched_points(*touches(servo))
    found, said = patent_circle(points), servo.common
    assert (said[511], said[512], said[513]) == pytest.approx((found.x, found.y, found.radius), abs=1e-9)
    assert said[514] == pytest.approx(found.eccentricity, abs=1e-9)
    assert math.radians(said[515]) == pytest.approx(found.phase, abs=1e-7)
    assert said[516] == pytest.approx(found.out_of_round(points), abs=1e-9)


@pytest.mark.parametrize("phase", [160.0, -20.0, -110.0])
def test_every_quadrant(tmp_path, phase):
    job = job_with({"work_eccentricity_phase_deg": phase, "work_eccentricity_mm": 0.3}, **PERFECT)
    wide = CYCLE[1].replace("Q0.3 R0.3", "Q0.6 R0.6")
    found = probed(job, cycle(tmp_path, CYCLE[0], wide), ideal=True).common
    assert found[514] == pytest.approx(0.3, abs=1e-5)
    assert (found[515] - phase + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=1e-2)


def test_latency_and_feed_move_every_touch_inwards(tmp_path):
    """1 mm/s for 2.3 ms."""
    job = job_with(**PERFECT | {"latency_s": 0.0023})
    radius, c = touches(probed(job, cycle(tmp_path, *CYCLE), ideal=True))
    assert radius == pytest.approx(law(job, c) - 0.0023, abs=1e-9)


def test_repeatability_is_seeded_and_as_large_as_it_says(tmp_path):
    lines = ("G00 X140. Z-6.", "G65 P9810 A80. D78. Q0.3 R0.3 F60.")
    program = cycle(tmp_path, *lines)

    def off(seed):
        job = job_with(repeatability_um=1.0, latency_s=0.0, seed=seed)
        radius, c = touches(probed(job, program, ideal=True))
        return (radius - law(job, c)) * 1e3

    first, again, other = off(3), off(3), off(4)
    assert first.tobytes() == again.tobytes()
    assert abs(first - other).max() > 0.5
    for found in (first, other):
        # chi squared of 80: 60 to 103 hold it with 95 % and more
        assert 0.8 < found.std() < 1.22
        assert abs(found.mean()) < 3.0 / math.sqrt(80)


def test_the_uncertainty_holds_what_it_says(tmp_path):
    """With 95 % confidence the true centre lies inside: of 12 seeds at most two may miss."""
    program = cycle(tmp_path, *CYCLE)
    missed = 0
    for seed in range(12):
        job = job_with(repeatability_um=0.5, latency_s=0.0, seed=seed)
        points = touched_points(*touches(probed(job, program, ideal=True)))
        found = find_centre(points, repeatability_mm=0.5e-3)
        missed += math.hypot(found.geometric.x - TRUE[0], found.geometric.y - TRUE[1]) > found.uncertainty_mm
    assert missed <= 2


def test_a_lobed_band_is_seen_by_both_machines(tmp_path):
    """Three lobes of 10 µm: r = R + 5 µm cos(3 (θ − 20°)), θ = −C facing the ball."""
    faults = {"band_out_of_round_mm": 0.01, "band_lobes": 3, "band_lobes_phase_deg": 20.0}
    job = job_with(faults, **PERFECT)
    for ideal in (True, False):
        radius, c = touches(probed(job, cycle(tmp_path, *CYCLE), ideal=ideal))
        bump = 0.005 * np.cos(3.0 * (-c - math.radians(20.0)))
        assert radius - law(job, c) == pytest.approx(bump, abs=0.2e-3)
        assert np.ptp(radius - law(job, c) - bump) < 0.05e-3


def test_a_tilted_part_is_probed_off_its_middle(tmp_path):
    """Leaning by 0.1° towards φ, the hub's axis at z = −6 stands 12.5 mm above the middle: 21.8 µm further
    off, and its section is an ellipse, 0.06 µm out of round."""
    job = job_with({"work_tilt_deg": 0.1, "work_tilt_phase_deg": 70.0}, **PERFECT)
    found = probed(job, cycle(tmp_path, *CYCLE), ideal=True).common
    assert found[514] == pytest.approx(0.05 + 12.5 * math.tan(math.radians(0.1)), abs=2e-5)


def test_probing_and_grinding_in_one_program(tmp_path):
    """The tool comes back in the probe's place: X reads the diameter at its own tip again."""
    lines = (*CYCLE, "G28 U0", "T0101", "G00 X200.")
    session = probed(job_with(**PERFECT), cycle(tmp_path, *lines), ideal=True)
    assert session.alarms == ()
    x = session.recording.setpoint[:, 0]
    assert set(session.recording.tool.tolist()) == {9, 1}
    assert x[-1] == pytest.approx(100.0 - 200.0)
    at_touch = x[session.recording.tool == 9].min()
    assert at_touch == pytest.approx(39.0 - 0.1 + 20.0 - 200.0, abs=0.06)
    assert [m for _, m in session.motions if len(m.time_s) and m.centre[:, 0].min() < 60.0] == []


def test_the_scene_stands_as_the_helper_says():
    assert (SCENE / "job.toml").read_text().count("[-12.0, 78.0]") == 1
    assert BAND_RADIUS == 39.0
    assert replace(job_with()).faults.work_eccentricity_mm == 0.05
