"""Parts that differ by a known amount."""

import math

import numpy as np
import pytest

from twin.comparison.changes import changes
from twin.comparison.compare import compare
from twin.cutting.stock import lathe
from twin.errors import InputError
from twin.inspection.inspection import inspect
from twin.inspection.solid import check_solid

TEETH, MODULE = 12, 2.0
BASE = TEETH * MODULE / 2 * math.cos(math.radians(20.0))


def part(vertices, faces):
    return check_solid(vertices, faces), inspect(vertices, faces)


def gear(parts, **more):
    return parts.gear_mesh(teeth=TEETH, module=MODULE, width=6.0, roll_step=0.2, z_step=1.0, **more)


def cylinder(radius, segments=200):
    solid = lathe(
        np.array([[0.0, -5.0], [radius, -5.0], [radius, -2.5], [radius, 0.0], [0.0, 0.0]]), segments
    ).to_mesh64()
    return solid.vert_properties[:, :3], np.array(solid.tri_verts, dtype=np.int64)


def turned(mesh, angle):
    cos, sin = math.cos(angle), math.sin(angle)
    vertices, faces = mesh
    return vertices @ np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]]), faces


@pytest.mark.parametrize("offset_um", [10.0, -10.0])
def test_a_cylinder_that_is_larger_by_ten_micrometres(offset_um):
    found = compare(part(*cylinder(8.0 + offset_um / 1000)), part(*cylinder(8.0)))
    x, y, z = check_solid(*cylinder(8.0)).vertices.T
    girth = (np.hypot(x, y) > 7) & (z == -2.5)
    assert girth.sum() == 200
    # within B the nearest point is not its edge but the middle of a facet beside it
    expected = offset_um * (1.0 if offset_um > 0 else math.cos(math.pi / 200))
    assert found.deviation_um[girth] == pytest.approx(np.full(200, expected), abs=1e-5)
    assert found.deviation_um[np.hypot(x, y) < 1] == pytest.approx(0.0, abs=1e-6)
    end = found.surface.most if offset_um > 0 else found.surface.least
    assert end.deviation_um == pytest.approx(expected, abs=1e-5)
    assert end.radius_mm == pytest.approx(8.0 + offset_um / 1000)
    assert found.largest_um == pytest.approx(10.0, abs=0.01)
    assert any("surfaces alone" in note for note in found.notes)


def test_the_reverse_shows_what_the_part_has_no_vertex_for():
    """A pip of 50 µm in the middle of B's end face: A, which is flat there, has only its rim."""
    vertices, faces = cylinder(8.0, segments=60)
    pip = vertices.copy()
    centre = np.flatnonzero((np.hypot(*vertices[:, :2].T) < 1e-9) & (vertices[:, 2] == 0.0))
    assert len(centre) == 1
    pip[centre, 2] = 0.05
    found = compare(part(vertices, faces), part(pip, faces))
    assert found.reverse.most.deviation_um == pytest.approx(50.0, abs=1e-6)


def test_the_same_part_differs_by_nothing(parts):
    one = part(*gear(parts))
    found = compare(one, one)
    assert found.largest_um == 0.0
    assert not found.deviation_um.any()
    assert found.surface.rms_um == 0.0
    assert not any(change.changed for change in found.changes)
    assert all(change.difference in (0.0, None) for change in found.changes)
    assert len(found.changes) > 50


def test_a_gear_turned_by_a_known_angle(parts):
    """Its flanks stand r_b δ off, one side out and the other in (geometry.md 1)."""
    angle = math.radians(0.02)
    found = compare(part(*turned(gear(parts), angle)), part(*gear(parts)))
    vertices = turned(gear(parts), angle)[0]
    radius = np.hypot(vertices[:, 0], vertices[:, 1])
    flank = (radius > 11.6) & (radius < 13.4) & (vertices[:, 2] < -1) & (vertices[:, 2] > -5)
    size = np.abs(found.deviation_um[flank])
    assert size == pytest.approx(np.full(flank.sum(), 1000 * BASE * angle), rel=0.02)
    assert (found.deviation_um[flank] > 0).mean() == pytest.approx(0.5, abs=0.01)


def test_the_place_of_one_thick_tooth(parts):
    def thick(tooth, side, roll, z):
        return np.full_like(roll, 0.012 if tooth == 4 else 0.0)

    found = compare(part(*gear(parts, error=thick)), part(*gear(parts)))
    # the generator counts from 0 against the clock, the sheet from 1 with it: 12 - 4 + 1
    assert found.surface.most.place == "tooth 9"
    x, y, _ = found.surface.most.position_mm
    assert math.degrees(math.atan2(y, x)) == pytest.approx(4 * 30.0, abs=10.0)
    assert found.surface.most.deviation_um == pytest.approx(12.0, rel=0.02)
    assert found.surface.percentiles_um[90] < 1.0
    assert found.surface.percentiles_um[50] < 1e-3
    by_key = {change.key: change for change in found.changes}
    assert by_key["flanks.left.single_pitch_um"].changed
    assert by_key["flanks.left.single_pitch_um"].difference == pytest.approx(
        12.0 / math.cos(math.radians(20.0)), rel=0.01
    )
    assert not by_key["number_of_teeth"].changed


def test_kinds_that_differ_are_said(parts):
    hexagon = part(*parts.polygon_mesh(across_flats=20.0, cutter_radius=40.0, inserts=3, sides=6, width=6.0))
    found = compare(part(*gear(parts)), hexagon)
    assert found.notes == ("A is a gear, B is a polygon: their figures have little in common",)
    by_key = {change.key: change for change in found.changes}
    assert (by_key["kind"].a, by_key["kind"].b, by_key["kind"].changed) == ("gear", "polygon", True)
    assert by_key["number_of_sides"].a is None
    assert by_key["number_of_sides"].changed
    assert found.reverse.most.place.startswith("face ")


def test_inches_taken_for_millimetres_are_refused(parts):
    vertices, faces = gear(parts)
    with pytest.raises(InputError) as refused:
        compare((check_solid(vertices / 25.4, faces), inspect(vertices, faces)), part(vertices, faces))
    assert "in inches" in refused.value.text
    assert "--against-units" in refused.value.remedy


def test_a_difference_within_the_uncertainty_is_no_change():
    def figures(value, facets):
        return {"kind": "gear", "span_mm": value, "uncertainty": {"span_mm": facets}, "number_of_teeth": 20}

    for other, changed in ((15.3008, False), (15.3012, True)):
        found = {c.key: c for c in changes(figures(15.3, 0.0004), figures(other, 0.0006))}
        assert found["span_mm"].uncertainty == pytest.approx(0.001)
        assert found["span_mm"].changed is changed
        assert found["number_of_teeth"].uncertainty == 0.0
