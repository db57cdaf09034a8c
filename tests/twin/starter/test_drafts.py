"""Drafts against the closed forms of geometry.md and against the controller that reads them."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from controller.language.source import load_program
from twin.advice.dry import advised_run
from twin.advice.gear_law import generating_flat, roll_angle
from twin.errors import InputError
from twin.inspection.tolerances import GearSize, across_flats_limits, gear_tolerance
from twin.job import read_job
from twin.presets import cutters_of, settings_of
from twin.starter.approach import clearance
from twin.starter.gear import GearOrder, draft_gear
from twin.starter.polygon import PolygonOrder, draft_polygon

few = settings(derandomize=True, deadline=None, max_examples=25, database=None)


def written(draft, folder):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "job.toml").write_text(draft.job, encoding="utf-8")
    (folder / "program.nc").write_text(draft.program, encoding="utf-8")
    return read_job(folder)


def checked(job):
    """The controller's report, and what it, the job and the program together have to say."""
    cutters = cutters_of(job)
    settings = settings_of(job, cutters)
    report, advice = advised_run(job, cutters, settings, load_program(job.program))
    return report, [*report.alarms, *report.warnings, *advice]


@pytest.mark.parametrize(
    ("across", "inserts", "sides", "corners"),
    [(17, 3, 6, 19.600), (17, 2, 6, 19.822), (17, 1, 6, 20.079), (10, 2, 4, 14.118)],
)
def test_the_blank_has_room_for_the_corners_of_the_table(across, inserts, sides, corners, tmp_path):
    """geometry.md 3: across corners."""
    order = PolygonOrder(sides=sides, across_flats=across, tip_radius=40.0, inserts=inserts)
    blank = written(draft_polygon(order), tmp_path).work.diameter_mm
    assert corners + 0.0995 <= blank <= corners + 0.2005


def test_a_spur_hob_is_clear_at_the_textbook_distance():
    """geometry.md 2: sqrt(h (d_a0 - h))."""
    found = clearance(tip_radius=35.0, outside_radius=22.0, root_radius=17.5, swivel=0.0)
    assert found == pytest.approx(math.sqrt(4.5 * 65.5), abs=1e-9)


@few
@given(
    tip=st.floats(20.0, 80.0),
    outside=st.floats(8.0, 120.0),
    depth=st.floats(1.0, 7.0),
    swivel=st.floats(-50.0, 50.0),
    seed=st.integers(0, 99),
)
def test_no_point_of_the_blank_is_inside_a_clear_hob(tip, outside, depth, swivel, seed):
    """Distance of random points of the blank's front face from the hob's axis, by the cross product."""
    eta = math.radians(swivel)
    aside = clearance(tip_radius=tip, outside_radius=outside, root_radius=outside - depth, swivel=eta)
    rng = np.random.default_rng(seed)
    r, turn = outside * np.sqrt(rng.random(4000)), rng.uniform(-math.pi, math.pi, 4000)
    face = np.column_stack([r * np.cos(turn), r * np.sin(turn), np.zeros(4000)])
    axis = np.array([0.0, math.cos(eta), math.sin(eta)])

    def nearest(height):
        centre = np.array([outside - depth + tip, 0.0, height])
        return np.linalg.norm(np.cross(face - centre, axis), axis=1).min()

    assert nearest(aside + 1e-3) >= tip
    rim = np.linspace(-math.pi / 2, math.pi / 2, 20001)
    face = np.column_stack([outside * np.cos(rim), outside * np.sin(rim), 0.0 * rim])
    assert nearest(aside - 0.01) < tip


@few
@given(
    module=st.sampled_from([0.5, 1.0, 1.75, 2.0, 3.0, 5.0]),
    teeth=st.integers(12, 80),
    helix=st.sampled_from([-30.0, -12.5, 0.0, 8.0, 25.0]),
    shift=st.sampled_from([-0.3, 0.0, 0.5]),
    starts=st.integers(1, 3),
    grade=st.integers(5, 10),
    pressure=st.sampled_from([14.5, 20.0, 20.0, 25.0]),
)
def test_gear_drafts_check_clean(module, teeth, helix, shift, starts, grade, pressure, tmp_path_factory):
    order = GearOrder(
        module=module,
        teeth=teeth,
        helix_deg=helix,
        profile_shift=shift,
        starts=starts,
        accuracy_class=grade,
        pressure_angle_deg=pressure,
    )
    try:
        draft = draft_gear(order)
    except InputError as refused:
        assert "usual are up to 24 (valid: " in str(refused)
        valid = dict(re.findall(r"--(starts|class) (\d+)", str(refused)))
        assert valid
        changes = {"starts": "starts", "class": "accuracy_class"}
        for name, value in valid.items():
            draft_gear(replace(order, **{changes[name]: int(value)}))
        return
    job = written(draft, tmp_path_factory.mktemp("gear"))
    found, said = checked(job)
    assert said == []
    # ends where it retracts: beside the blank, clear of it
    assert found.absolute["Z"] < -10.0 * module - 1.9
    assert found.absolute["X"] > job.work.diameter_mm + 3.9
    # the marks of the feed hold their share of the class
    feed = next(
        float(w[1:]) for line in job.program.read_text().split("\n") for w in line.split() if w[0] == "F"
    )
    beta = math.radians(helix)
    hob = job.tools[0]
    mark = (feed / math.cos(beta)) ** 2 * math.sin(math.radians(pressure)) / (4.0 * hob.pitch_diameter) * 1e3
    size = GearSize(
        number_of_teeth=teeth,
        reference_diameter=teeth * module / math.cos(beta),
        normal_module=module,
        face_width=10.0 * module,
        helix_angle=helix,
    )
    assert mark <= 0.5 * gear_tolerance("helix_form", size, grade) + 1e-9
    # and so do the flats of its gashes, at the tip
    transverse = math.atan(math.tan(math.radians(pressure)) / math.cos(beta))
    base = size.reference_diameter / 2.0 * math.cos(transverse)
    flat = 1e3 * generating_flat(
        base_radius=base,
        roll=roll_angle(radius=job.work.diameter_mm / 2.0, base_radius=base),
        starts=starts,
        gashes=hob.gashes,
        teeth=teeth,
    )
    assert flat <= 0.5 * gear_tolerance("profile_form", size, grade) + 1e-9


@few
@given(sides=st.integers(3, 12), across=st.floats(5.0, 40.0), length=st.floats(2.0, 30.0))
def test_polygon_drafts_check_clean(sides, across, length, tmp_path_factory):
    order = PolygonOrder(sides=sides, across_flats=round(across, 2), length=round(length, 1))
    try:
        draft = draft_polygon(order)
    except InputError as refused:
        # few and odd sides: at a ratio below 2 faces are more convex
        assert sides in (3, 5)
        widest = re.search(r"--across-flats up to (\d+)", str(refused)).group(1)
        draft_polygon(replace(order, across_flats=float(widest)))
        return
    job = written(draft, tmp_path_factory.mktemp("polygon"))
    _, said = checked(job)
    assert said == []
    assert job.work.diameter_mm > order.across_flats
    # convex, and within half of h13 on both sides: the path of one edge, point by point (geometry.md 3)
    head, pitch = job.tools[0], math.pi / sides
    theta = np.linspace(-math.pi / 2, math.pi / 2, 200_001)
    ratio = sides / head.inserts
    radius = head.tip_radius_mm
    path = (order.across_flats / 2 + radius) * np.exp(-1j * theta) - radius * np.exp(1j * (ratio - 1) * theta)
    face = path[np.abs(np.angle(path)) <= pitch].real
    tolerance = np.subtract(*across_flats_limits(order.across_flats, "h13"))
    assert face.argmax() == pytest.approx(len(face) / 2, abs=1)
    assert 0.0 <= 2.0 * np.ptp(face) <= 0.5 * abs(tolerance) + 1e-6


@pytest.mark.parametrize(
    ("order", "said"),
    [
        (GearOrder(module=0.0, teeth=20), "--module 0 (valid: 0.5 to 10)"),
        (GearOrder(module=2.0, teeth=2), "--teeth 2 (valid: 5 to 1000)"),
        (GearOrder(module=2.0, teeth=20, helix_deg=80.0), "--helix 80 (valid: -45 to 45)"),
        (GearOrder(module=2.0, teeth=20, bore=40.0), "a bore of 40 mm leaves no rim (valid: 0 to 33.000)"),
        (GearOrder(module=2.0, teeth=20, hob_diameter=4.0), "a hob of outside diameter 4 mm is too small"),
    ],
)
def test_gears_that_cannot_be_drafted(order, said):
    with pytest.raises(InputError) as refused:
        draft_gear(order)
    assert said in str(refused.value)


@pytest.mark.parametrize("inserts", [1, 2, 4])
def test_any_number_of_inserts_cuts_all_sides(inserts, tmp_path):
    """P inserts at Q / P: as ordered, even where faces are concave, which the check says."""
    job = written(draft_polygon(PolygonOrder(sides=6, across_flats=17.0, inserts=inserts)), tmp_path)
    _, said = checked(job)
    assert [one.number for one in said] == ([] if inserts == 4 else ["HT9202"])
    assert f"G51.2 P{inserts} Q6" in job.program.read_text()


@pytest.mark.parametrize(("pressure", "factor"), [(14.5, 0.38), (20.0, 0.38), (25.0, 0.31), (30.0, 0.11)])
def test_tips_are_as_round_as_there_is_room(pressure, factor, tmp_path):
    """One arc from flank to flank: (π/4 − 1.25 tan α) cos α / (1 − sin α), 0.318 at 25°, 0.110 at 30°."""
    job = written(draft_gear(GearOrder(module=2.0, teeth=20, pressure_angle_deg=pressure)), tmp_path)
    assert job.tools[0].tip_radius_factor == pytest.approx(factor)


def test_a_polygon_that_no_head_turns():
    with pytest.raises(InputError) as refused:
        draft_polygon(PolygonOrder(sides=3, across_flats=24.0))
    assert "no usual head turns 3 faces 24 mm across flats within h13 (valid: --across-flats up to" in str(
        refused.value
    )
