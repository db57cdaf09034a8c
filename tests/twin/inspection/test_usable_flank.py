"""Undercut, fillet and tip chamfer: the evaluation keeps to the usable flank and says where it is."""

import math

import numpy as np
import pytest

from twin.inspection.inspection import inspect
from twin.inspection.involute import geometry
from twin.inspection.result import Verdict
from twin.inspection.usable import steep_ends

UNDERCUT = [(8, 3.0, 0.0), (10, 3.0, 0.0), (12, 3.0, 0.0), (14, 3.0, 0.0), (16, 3.0, 0.0)]
CLEAR = [(20, 2.0, 0.0), (40, 2.0, 0.0), (12, 3.0, 0.5)]


def form_diameter(parts, teeth, module, shift):
    """Where the path of the rack's corner meets the involute."""
    return 2 * parts.rack_corner(teeth, module, shift, math.radians(20.0))[0][-1]


@pytest.mark.parametrize(("teeth", "module", "shift"), UNDERCUT + CLEAR)
def test_form_diameter_is_where_the_rack_corner_meets_the_involute(parts, named, teeth, module, shift):
    wanted = form_diameter(parts, teeth, module, shift)
    gear = geometry(named(teeth=teeth, module=module, shift=shift))
    assert gear.form_diameter == pytest.approx(wanted, abs=1e-6)
    assert gear.undercut is ((teeth, module, shift) in UNDERCUT)


@pytest.mark.parametrize(("teeth", "module", "shift"), UNDERCUT + CLEAR)
def test_real_roots_are_left_out_of_the_profile(parts, named, teeth, module, shift):
    mesh = parts.gear_mesh(
        teeth=teeth, module=module, shift=shift, trochoid=True, width=8.0, z_step=8.0, roll_step=0.03
    )
    wanted = form_diameter(parts, teeth, module, shift)
    for nominal in (named(teeth=teeth, module=module, shift=shift), None):
        result = inspect(*mesh, nominal)
        gear = result.gear
        assert gear.normal_module_mm == pytest.approx(module, rel=1e-5)
        assert gear.form_diameter_mm == pytest.approx(wanted, abs=1e-4)
        assert gear.undercut is ((teeth, module, shift) in UNDERCUT)
        # close to the base circle the mesh's own chords show, and are said
        assert gear.left.profile_total_um < 0.15 + gear.left.uncertainty["profile_total_um"]
        if teeth >= 12:
            assert gear.left.profile_total_um < 0.15
    said = " ".join(inspect(*mesh, named(teeth=teeth, module=module, shift=shift)).findings)
    assert ("the teeth are undercut: the usable flank begins at" in said) is gear.undercut


def test_an_undercut_that_the_nominal_does_not_know(parts, named):
    """A nominal whose tool would reach less deep: the mesh shows where its flank begins."""
    mesh = parts.gear_mesh(teeth=10, module=3.0, trochoid=True, width=8.0, z_step=8.0, roll_step=0.02)
    nominal = named(teeth=10, module=3.0, dedendum_factor=1.0, tip_radius_factor=0.3)
    wanted = form_diameter(parts, 10, 3.0, 0.0)
    assert geometry(nominal).form_diameter < wanted - 0.1
    gear = inspect(*mesh, nominal).gear
    assert gear.undercut
    assert gear.form_diameter_mm == pytest.approx(wanted, abs=0.01)
    assert gear.left.profile_total_um < 0.15 + gear.left.uncertainty["profile_total_um"]


@pytest.mark.parametrize("slope", [0.15, 0.3, 1.0])
def test_steep_ends_begin_at_their_corners(slope):
    """A fillet below 2 mm, a chamfer above 9 mm, a wave of 3 µm between; one flank with neither; a hole."""
    roll = np.linspace(0.5, 10.5, 1001)
    wave = 0.0015 * np.sin(2 * math.pi * roll / 1.3)
    ends = slope * np.maximum(2.0 - roll, 0) - slope * np.maximum(roll - 9.0, 0)
    torn = np.where(roll < 3.0, np.nan, wave)
    first, last = steep_ends(roll, np.array([wave + ends, wave, torn]))
    assert first.tolist()[1:] == [0, 250]
    assert last.tolist()[1:] == [1000, 1000]
    assert roll[first[0]] == pytest.approx(2.0, abs=0.031)
    assert roll[last[0]] == pytest.approx(9.0, abs=0.031)


def test_a_gentle_fillet_above_the_form_diameter_is_a_deviation(parts, named):
    """The rack's own fillet rises by 22 µm where the nominal wants an involute: a mate's tip meets it."""
    mesh = parts.gear_mesh(teeth=30, module=2.0, trochoid=True, width=8.0, z_step=8.0, roll_step=0.05)
    nominal = named(teeth=30, dedendum_factor=1.6, accuracy_class=6)
    radius, gap = parts.rack_corner(30, 2.0, 0.0, math.radians(20.0))
    r_b = 30 * math.cos(math.radians(20.0))
    half_at_base = math.pi / 60 + math.tan(math.radians(20.0)) - math.radians(20.0)
    angle = np.arccos(np.minimum(r_b / radius, 1.0))
    excess = r_b * (math.pi / 30 - gap - half_at_base + np.tan(angle) - angle)
    wanted = 1000 * np.interp(geometry(nominal).form_diameter / 2, radius, excess)
    result = inspect(*mesh, nominal)
    assert result.gear.left.profile_total_um == pytest.approx(wanted, rel=0.01)
    assert result.verdict is Verdict.OUT


@pytest.mark.parametrize("chamfer", [0.1, 0.2, 0.4, 0.8])
def test_tip_chamfers(parts, named, chamfer):
    mesh = parts.gear_mesh(teeth=20, module=2.0, chamfer=chamfer, width=8.0, z_step=8.0, roll_step=0.05)
    for nominal in (named(accuracy_class=1), None):
        result = inspect(*mesh, nominal)
        gear = result.gear
        assert gear.chamfered
        assert gear.tip_diameter_mm == pytest.approx(44.0, abs=1e-6)
        assert gear.tip_form_diameter_mm == pytest.approx(44.0 - 2 * chamfer, abs=0.03)
        assert gear.profile_range_mm[1] < 44.0 - 2 * chamfer
        assert gear.normal_module_mm == pytest.approx(2.0, rel=1e-5)
        assert gear.left.profile_total_um < 0.15
    assert inspect(*mesh, named(accuracy_class=1)).verdict is Verdict.IN


def test_a_plain_tip_is_no_chamfer(parts, named):
    result = inspect(*parts.gear_mesh(teeth=20, module=2.0, width=8.0, z_step=8.0, roll_step=0.05), named())
    assert not result.gear.chamfered
    assert result.gear.tip_form_diameter_mm == pytest.approx(44.0, abs=1e-6)
    # from the form diameter 95 % of the roll length to the tip form diameter
    start, end = (math.sqrt((d / 2) ** 2 - (20 * math.cos(math.radians(20))) ** 2) for d in (37.640133, 44.0))
    low, high = result.gear.left.profile[0].evaluation
    assert (low, high) == pytest.approx((start, start + 0.95 * (end - start)), abs=1e-5)


def rough(amplitude, seed=3):
    """Facets 0.2 mm wide whose corners stray by so much [µm]: slopes of up to 0.1 at 10 µm, no chamfer's."""
    rng = np.random.default_rng(seed)

    def error(tooth, side, roll, z):
        return amplitude / 1000 * rng.uniform(-1, 1, len(roll))

    return {"error": error, "width": 3.0, "z_step": 0.5, "roll_step": 0.2}


@pytest.mark.parametrize(
    ("amplitude", "chamfer"), [(3.0, 0.0), (3.0, 0.1), (10.0, 0.0), (10.0, 0.3), (10.0, 0.8)]
)
def test_a_rough_mesh_shows_its_chamfer_and_no_other(parts, named, amplitude, chamfer):
    mesh = parts.gear_mesh(teeth=30, module=2.0, chamfer=chamfer, **rough(amplitude))
    for nominal in (named(teeth=30), None):
        gear = inspect(*mesh, nominal).gear
        assert gear.chamfered is (chamfer > 0)
        assert gear.tip_form_diameter_mm == pytest.approx(64.0 - 2 * chamfer, abs=0.06)
        wanted = geometry(named(teeth=30)).form_diameter
        assert gear.form_diameter_mm == pytest.approx(wanted, abs=0.02)


@pytest.mark.parametrize(("teeth", "undercut"), [(10, True), (14, True), (30, False)])
def test_a_rough_mesh_shows_its_root(parts, named, teeth, undercut):
    mesh = parts.gear_mesh(teeth=teeth, module=3.0, trochoid=True, **rough(6.0))
    for nominal in (named(teeth=teeth, module=3.0), None):
        gear = inspect(*mesh, nominal).gear
        assert gear.undercut is undercut
        assert gear.form_diameter_mm == pytest.approx(form_diameter(parts, teeth, 3.0, 0.0), abs=0.02)
        assert not gear.chamfered


def test_folds_of_a_mesh_are_no_holes(parts, named):
    """Where two cuts meet a mesh may run back on itself by a micrometre: three crossings, one flank."""
    whole = parts.gear_mesh(teeth=20, module=2.0, width=3.0, z_step=1.0, roll_step=0.04)
    vertices = whole[0].copy()
    fraction = (np.hypot(*vertices[:, :2].T) - 17.5) / 4.5
    sought = np.flatnonzero((fraction > 0.3) & (fraction < 0.9))
    place = sought[::17]
    vertices[[place, place + 1]] = vertices[[place + 1, place]]
    assert len(place) > 400
    for nominal in (named(accuracy_class=1), None):
        gear = inspect(vertices, whole[1], nominal).gear
        assert gear.number_of_teeth == 20
        assert not gear.chamfered
        assert gear.form_diameter_mm == pytest.approx(geometry(named()).form_diameter, abs=1e-5)
        assert gear.teeth_range_mm == (-3.0, 0.0)
        for flank in (gear.left, gear.right):
            assert len(flank.profile) == len(flank.helix) == 4
            assert all(len(trace.position) == 480 for trace in flank.profile)
            assert flank.profile_total_um < 0.15
        assert gear.runout_um < 0.15
