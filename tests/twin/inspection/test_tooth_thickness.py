"""Tooth thickness and its chord: published tables, and parts of known profile shift."""

import math

import pytest

from twin.inspection.inspection import inspect
from twin.inspection.involute import geometry
from twin.inspection.nominal import GearNominal
from twin.inspection.thickness import chordal


@pytest.mark.parametrize(
    ("gear", "chord", "height"),
    [
        # geometry.md, section 1: SDP/SI tables 10-1 and 10-3
        ({"number_of_teeth": 12, "normal_module_mm": 10.0, "profile_shift": 0.3}, 17.8256, 13.6657),
        (
            {
                "number_of_teeth": 16,
                "normal_module_mm": 5.0,
                "helix_angle_deg": 25.0,
                "profile_shift": 0.2,
            },
            8.5728,
            6.1712,
        ),
    ],
)
def test_published_chords(gear, chord, height):
    nominal = geometry(GearNominal(**gear))
    thickness = (math.pi / 2 + 2 * nominal.shift * math.tan(math.radians(20))) * nominal.module
    found = chordal(nominal, thickness, tip_diameter=nominal.tip_diameter)
    assert found == pytest.approx((chord, height), abs=6e-5)


@pytest.mark.parametrize(
    "words", [{}, {"shift": 0.4}, {"helix_deg": 20.0}, {"helix_deg": -15.0, "shift": -0.2}]
)
def test_measured_thickness(parts, named, words):
    step = {"z_step": 0.5, "roll_step": 0.1} if "helix_deg" in words else {"z_step": 10.0, "roll_step": 0.05}
    gear = inspect(*parts.gear_mesh(teeth=20, module=2.0, **words, **step), named(**words)).gear
    wanted = math.pi + 4 * words.get("shift", 0.0) * math.tan(math.radians(20))
    assert gear.tooth_thickness_mm == pytest.approx(wanted, abs=gear.uncertainty["tooth_thickness_mm"] + 1e-5)
    assert gear.chordal_thickness_mm < gear.tooth_thickness_mm
    assert gear.chordal_height_mm > 2 * (1 + words.get("shift", 0.0))


def test_thickness_follows_the_flanks(parts, named):
    """10 µm on the left and 20 µm on the right, normal to the flank: 30 µm / cos alpha along the circle."""

    def thicker(tooth, side, roll, z):
        return 0 * roll + (0.01 if side > 0 else 0.02)

    mesh = parts.gear_mesh(teeth=20, module=2.0, z_step=10.0, roll_step=0.05, error=thicker)
    gear = inspect(*mesh, named()).gear
    assert gear.tooth_thickness_mm == pytest.approx(math.pi + 0.03 / math.cos(math.radians(20)), abs=1e-5)


def test_a_reference_circle_outside_the_flank_is_said(parts, named):
    mesh = parts.gear_mesh(teeth=30, module=2.0, shift=1.2, z_step=10.0, roll_step=0.1)
    result = inspect(*mesh, named(teeth=30, shift=1.2))
    assert result.gear.tooth_thickness_mm is None
    assert "does not meet the usable flank" in result.unmeasured["chordal_thickness_mm"]
