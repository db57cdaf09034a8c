"""Gaps ground by strokes: every point of the flank against the involute, and a blank clamped off centre."""

import math
from dataclasses import replace

import numpy as np
import pytest

from twin.cutters.disc_wheel import DiscWheel
from twin.cutting.blank import Blank
from twin.cutting.cut import cut
from twin.cutting.fields import tool_field
from twin.cutting.motion import RigidTransform
from twin.cutting.stock import blank_solid
from twin.cutting.strokes import find_strokes
from twin.cutting.sweep import Sweep
from twin.grinding.precut import PrecutGear
from twin.grinding.wheel import GapWheel
from twin.inspection.involute import geometry
from twin.inspection.nominal import GearNominal

STOCK = 0.1
CHORD = 1.0  # µm


def gear(helix):
    return GearNominal(number_of_teeth=30, normal_module_mm=3.0, helix_angle_deg=helix)


def precut(helix):
    law = geometry(gear(helix))
    blank = PrecutGear(
        stock_per_flank_mm=STOCK, number_of_teeth=30, normal_module_mm=3.0, helix_angle_deg=helix
    )
    radius = law.tip_diameter / 2
    section = blank.section(radius)
    return law, Blank(diameter_mm=2 * radius, length_mm=4.0, bore_mm=60.0, section=section)


def ground(synthetic, helix, *, mount=None, ripple=0.0):
    law, blank = precut(helix)
    wheel = GapWheel(outside_diameter_mm=100.0, chord_um=CHORD).dressed(gear(helix))
    cutter, motion = synthetic.grinding(
        wheel, teeth=30, module=3.0, helix_deg=helix, tip_x=law.root_diameter / 2, z=(30.0, -34.0), gaps=3,
        samples=500,
    )  # fmt: skip
    # the synthetic motion stands at its first height at angle 0, the pre-cut gap at the front face
    motion = replace(motion, work_angle=motion.work_angle - law.twist * 30.0)
    if ripple:
        wave = ripple * np.sin(2.0 * math.pi * motion.centre[:, 2] / 1.1)
        motion = replace(motion, centre=motion.centre + wave[:, None] * [1.0, 0.0, 0.0])
    if mount is not None:
        motion = replace(motion, mount=mount)
    return law, blank, cut(blank, ((cutter, motion),), cell_mm=0.5)


def beyond(law, points, centre=0j):
    """How far points in the three ground gaps lie in the tooth [µm], and their radii."""
    place = (points[:, 0] + 1j * points[:, 1] - centre) * np.exp(-1j * law.twist * points[:, 2])
    pitch = 2 * math.pi / law.teeth
    angle = np.angle(place) + pitch * np.arange(3)[:, None]
    gap = np.abs(angle).argmin(axis=0)
    off = np.abs(angle[gap, np.arange(len(points))]) - pitch / 2 + law.half_tooth(np.abs(place))
    near = np.abs(angle).min(axis=0) < pitch / 2
    return 1e3 * law.base_radius * off, np.abs(place), near


@pytest.mark.parametrize("helix", [0.0, 15.0, -15.0])
def test_ground_flanks_are_the_involute_within_the_dressers_chords(synthetic, helix):
    law, _, found = ground(synthetic, helix)
    assert found.method.startswith("strokes")
    assert found.largest_error_um < 0.1
    v = found.remains.vertices.astype(float)
    off, r, near = beyond(law, v)
    inside = (v[:, 2] > -3.99) & (v[:, 2] < -0.01) & near
    flank = inside & (r > law.form_diameter / 2 + 0.1) & (r < law.tip_diameter / 2 - 0.02)
    # the dresser's chords cut up to CHORD into the flank, the instants between samples leave next to nothing
    on = flank & (np.abs(off) < 20)
    assert on.sum() > 300
    assert (flank & ~on).sum() == 0
    assert off[on].min() > -0.1
    assert off[on].max() < 1.02 * CHORD / math.cos(law.base_helix)
    root = inside & (r < law.root_diameter / 2 + 0.5)
    assert r[root].min() == pytest.approx(law.root_diameter / 2, abs=2e-3)


@pytest.mark.parametrize("helix", [0.0, 15.0])
def test_slides_that_swing_on_their_way_leave_every_hump(synthetic, helix):
    """4 µm to and fro, 1.1 mm apart: near every flank point several instants are deeper than their
    neighbours, and the deepest of all has formed it."""
    _, _, found = ground(synthetic, helix, ripple=4e-3)
    assert found.method.startswith("strokes")
    assert found.largest_error_um < 0.1


def test_an_eccentric_blank_is_ground_about_the_spindle(synthetic):
    """Part frame: the spindle's axis stands at −e; flanks are the involute about that."""
    e = 0.05 * np.exp(1j * math.radians(70.0))
    mount = RigidTransform(translation=np.array([e.real, e.imag, 0.0]))
    law, _, found = ground(synthetic, 0.0, mount=mount)
    v = found.remains.vertices.astype(float)
    off, r, near = beyond(law, v, centre=-e)
    flank = near & (np.abs(v[:, 2] + 2) < 1.9) & (r > law.form_diameter / 2 + 0.1) & (r < 47.9)
    assert flank.sum() > 300
    assert off[flank].min() > -0.1
    assert off[flank].max() < 1.02 * CHORD


@pytest.mark.parametrize("helix", [0.0, 20.0])
def test_the_volume_of_a_precut_gear_is_its_section_times_its_length(helix):
    law, blank = precut(helix)
    solid = blank_solid(blank)
    # teeth by quadrature of their angles over the radius, from the form circle out
    rng = np.random.default_rng(3)
    low, high = law.form_diameter / 2 + 0.3, law.tip_diameter / 2
    r = np.sqrt(rng.uniform(low**2, high**2, 200_000))
    angle, z = rng.uniform(0, 2 * math.pi, len(r)), rng.uniform(-4, 0, len(r))
    inside = blank.contains(np.column_stack([r * np.cos(angle), r * np.sin(angle), z]))
    grid = np.linspace(low, high, 4001)
    lift = STOCK / (law.base_radius * math.cos(law.base_helix))
    tooth = 2 * law.teeth * (law.half_tooth(grid) + lift)
    share = np.trapezoid(tooth * grid, grid) / (math.pi * (high**2 - low**2))
    assert inside.mean() == pytest.approx(share, abs=4 * math.sqrt(0.25 / len(r)))
    assert solid.genus() == 1
    everywhere = rng.uniform([-48.1, -48.1, -4.0], [48.1, 48.1, 0.0], (200_000, 3))
    if helix == 0:
        box = 96.2**2 * 4.0
        assert solid.volume() == pytest.approx(blank.contains(everywhere).mean() * box, rel=0.01)


def test_a_stroke_that_ends_in_the_gap_is_none_along_it(synthetic):
    law, blank = precut(0.0)
    wheel = GapWheel(outside_diameter_mm=100.0, chord_um=5.0).dressed(gear(0.0))
    cutter, motion = synthetic.grinding(
        wheel, teeth=30, module=3.0, tip_x=law.root_diameter / 2, z=(30.0, -2.0), gaps=2
    )
    assert find_strokes(blank, cutter, motion, 0.5) is None


FLOOR, TIP, GAPS = 17.5, 22.0, 55
WHEEL = DiscWheel(outside_diameter_mm=60.0, normal_module_mm=2.0, tip_radius_factor=0.0)


def overlapping(synthetic, helix, cell):
    """Three gaps so close to each other that the wheel's flanks meet below the blank's outside."""
    tool = synthetic.grinding(
        WHEEL, teeth=GAPS, module=2.0 * 20 / GAPS, helix_deg=helix, tip_x=FLOOR, z=(16.0, -20.0), gaps=3
    )
    blank = Blank(diameter_mm=2 * TIP, length_mm=3.0, bore_mm=20.0)
    return tool, cut(blank, (tool,), cell_mm=cell)


def test_between_two_strokes_stands_the_ridge_of_both_profiles(synthetic):
    """Spur gaps are the wheel's own profile: two of them meet on the plane half way between."""
    _, found = overlapping(synthetic, 0.0, 0.4)
    assert found.method.startswith("strokes")
    v = found.remains.vertices.astype(float)
    pitch = 2 * math.pi / GAPS
    r, angle, z = np.hypot(v[:, 0], v[:, 1]), np.arctan2(v[:, 1], v[:, 0]), v[:, 2]
    # the work turns by a pitch from stroke to stroke: the gaps stand at 0, −1 and −2 of it
    off = np.full(len(v), -np.inf)
    for gap in range(3):
        x, y = r * np.cos(angle + gap * pitch), np.abs(r * np.sin(angle + gap * pitch))
        half = math.pi / 2.0 + (x - FLOOR - 2.5) * math.tan(math.radians(20.0))
        depth = np.minimum(x - FLOOR, (half - y) * math.cos(math.radians(20.0)))
        off = np.maximum(off, np.where(x > 0, depth, -np.inf))
    inside = (z > -2.999) & (z < -0.001) & (r < TIP - 1e-3) & (r > 10.1) & (off > -1.0)
    assert inside.sum() > 300
    # 7.6 nm of the file's grid, and that again across the corner
    assert np.abs(off[inside]).max() < 2e-5
    ridge = inside & (np.abs(angle + 0.5 * pitch) < 1e-4)
    assert ridge.sum() > 5
    half = math.radians(20.0)
    x = (math.pi / 2.0 - (FLOOR + 2.5) * math.tan(half)) / (math.tan(pitch / 2) - math.tan(half))
    np.testing.assert_allclose(r[ridge], x / math.cos(pitch / 2), atol=2e-5)


def test_ridges_between_helical_strokes_stand_on_the_cut_as_well(synthetic):
    """The boolean makes those ridges of facets: cells are made as fine as their vertices ask for."""
    (cutter, motion), found = overlapping(synthetic, 15.0, 0.8)
    assert found.method.startswith("strokes")
    assert found.largest_error_um <= 0.1
    field = Sweep((tool_field(cutter, motion, TIP, (-3.0, 0.0)),))
    v = found.remains.vertices.astype(float)
    r = np.hypot(v[:, 0], v[:, 1])
    inside = (v[:, 2] > -2.999) & (v[:, 2] < -0.001) & (r < TIP - 1e-3) & (r > 10.1)
    assert np.abs(field.unculled(v[inside])).max() < 1.2e-4
