"""The uncertainty beside a figure bounds what the mesh's own facets do to it, and no more."""

import math

import numpy as np
import pytest

from twin.inspection.inspection import inspect
from twin.inspection.result import Verdict
from twin.inspection.sheet import to_json

ITEMS = ("profile_slope", "profile_form", "profile_total", "helix_slope", "helix_form", "helix_total")
PITCHES = ("single_pitch", "cumulative_pitch")


def slanted(tooth, side, roll, z):
    return (2.0 * (roll - 7) + 0.5 * (z + 10)) / 1000


def coarse_and_fine(parts, named, **words):
    coarse, fine = (
        inspect(*parts.gear_mesh(teeth=20, module=2.0, error=slanted, **words, **step), named(**words)).gear
        for step in ({"z_step": 2.0, "roll_step": 0.8}, {"z_step": 0.2, "roll_step": 0.08})
    )
    return coarse, fine


@pytest.mark.parametrize("helix_deg", [0.0, 20.0, -20.0])
def test_coarse_meshes_stray_by_no_more_than_said(parts, named, helix_deg):
    """Chords of 0.8 mm across and 2 mm along against a mesh a hundred times finer."""
    coarse, fine = coarse_and_fine(parts, named, helix_deg=helix_deg)
    for side in ("left", "right"):
        one, other = getattr(coarse, side), getattr(fine, side)
        for item in ITEMS + PITCHES:
            key = f"{item}_um"
            allowed = one.uncertainty[key] + other.uncertainty[key] + 0.02
            assert abs(getattr(one, key) - getattr(other, key)) <= allowed, key
        if helix_deg == 0:
            # a chord of length s stands s²/8 rho inside its arc; rho is the roll length, s = rho d rho / r_b
            r_b = 20 * math.cos(math.radians(20))
            low, high = one.profile[0].evaluation
            step = (math.sqrt(22**2 - r_b**2) - low) / 14
            deepest = 1000 * high * step**2 / 8 / r_b**2
            assert one.uncertainty["profile_total_um"] == pytest.approx(deepest, rel=0.1)
    assert abs(coarse.span_mm - fine.span_mm) <= coarse.uncertainty["span_mm"] + fine.uncertainty["span_mm"]
    for key in ("over_pins_mm", "runout_um", "tooth_thickness_mm"):
        room = coarse.uncertainty[key] + fine.uncertainty[key] + 1e-5
        assert abs(getattr(coarse, key) - getattr(fine, key)) <= room, key


def test_it_stands_beside_the_figures(parts, named):
    mesh = parts.gear_mesh(teeth=20, module=2.0, z_step=10.0, roll_step=1.5)
    values = to_json(inspect(*mesh, named(accuracy_class=1)))
    for flank in values["flanks"].values():
        assert set(flank["uncertainty"]) == {
            f"{item}_um" for item in (*ITEMS, *PITCHES, "profile_crowning", "helix_crowning")
        }
        # a perfect gear reads what its facets make, no more
        assert flank["profile_total_um"] == pytest.approx(flank["uncertainty"]["profile_total_um"], rel=0.01)
    assert set(values["uncertainty"]) == {
        "span_mm", "over_pins_mm", "runout_um", "tooth_thickness_mm", "chordal_thickness_mm",
    }  # fmt: skip
    assert any("the mesh's facets alone can make" in finding for finding in values["findings"])


def test_fine_meshes_are_not_called_coarse(parts, named):
    mesh = parts.gear_mesh(teeth=20, module=2.0, z_step=10.0, roll_step=0.05)
    result = inspect(*mesh, named(accuracy_class=1))
    assert result.verdict is Verdict.IN
    assert result.findings == ("all measured items hold class 1 of ISO 1328-1:2013",)


@pytest.mark.parametrize(("points", "twist", "z_step"), [(12, 0.0, 1.0), (60, 3.6, 0.3), (25, -2.0, 0.5)])
def test_polygons(parts, points, twist, z_step):
    words = {"across_flats": 17.0, "cutter_radius": 40.0, "inserts": 3, "sides": 6, "width": 10.0}
    found = inspect(
        *parts.polygon_mesh(**words, points=points, twist_deg_per_mm=twist, z_step=z_step)
    ).polygon
    allowed = found.uncertainty
    assert abs(found.bow_um - 13.038) <= allowed["bow_um"] + 0.01
    assert abs(found.flatness_um - 13.038) <= allowed["flatness_um"] + 0.01
    for key in ("across_flats_mm", "across_flats_caliper_mm"):
        assert abs(getattr(found, key) - 17.0) <= allowed[key] + 1e-5
    if twist == 0.0:
        # the deepest chord of a face 9.8 mm wide with 13 µm of bow, cut into points - 1
        assert allowed["bow_um"] == pytest.approx(13.04 / (points - 1) ** 2, rel=0.3)


def test_a_flat_polygon_has_no_facets_to_doubt(parts):
    angle = np.radians(60.0 * np.arange(6))
    corner = 17.0 / math.sqrt(3) * np.column_stack([np.cos(angle), np.sin(angle)])
    sides = zip(corner, np.roll(corner, -1, axis=0), strict=True)
    ring = np.concatenate([np.linspace(a, b, 20, endpoint=False) for a, b in sides])
    mesh = parts.loft([np.column_stack([ring, np.full(len(ring), z)]) for z in np.linspace(-8, 0, 9)])
    assert max(inspect(*mesh).polygon.uncertainty.values()) < 1e-6
