"""What must not pass: teeth of the wrong thickness, wrong tips, more than one body, wrong units."""

import math
import re

import manifold3d as m3
import numpy as np
import pytest

from twin.inspection.inspection import inspect
from twin.inspection.nominal import PolygonNominal
from twin.inspection.result import Verdict
from twin.inspection.text import text_lines


@pytest.fixture(scope="module")
def spur(parts):
    return parts.gear_mesh(teeth=20, module=2.0, z_step=5.0, roll_step=0.1)


def beside(one, other, shift):
    (v, f), (w, g) = one, other
    return np.concatenate([v, w + np.asarray(shift, dtype=float)]), np.concatenate([f, g + len(v)])


# each flank moves by x m sin alpha_n = 0.684 x mm; 0.05 m_n is 0.1 mm
@pytest.mark.parametrize(
    ("shift", "verdict", "words"),
    [
        (0.14, Verdict.IN, "too thick by 0.204 mm"),
        (0.16, Verdict.OUT, "teeth too thick by 0.233 mm, not cut to depth; span over 3 teeth 15.540 mm"),
        (-0.14, Verdict.IN, "too thin by 0.204 mm"),
        (-0.16, Verdict.OUT, "teeth too thin by 0.233 mm, cut too deep; span over 3 teeth 15.102 mm"),
    ],
)
def test_teeth_of_the_wrong_thickness(parts, named, shift, verdict, words):
    mesh = parts.gear_mesh(
        teeth=20, module=2.0, shift=shift, tip_factor=1.0 - shift, z_step=5.0, roll_step=0.1
    )
    result = inspect(*mesh, named(accuracy_class=8))
    assert result.verdict is verdict
    said = result.findings[0 if verdict is Verdict.OUT else 1]
    assert words in said
    assert "wanted 15.321 mm" in said
    thickness = 2 * abs(shift) * 2.0 * math.tan(math.radians(20.0))
    assert float(re.search(r"by ([\d.]+) mm", said)[1]) == pytest.approx(thickness, abs=6e-4)
    # nothing is too thick that was not named
    assert inspect(*mesh).verdict is Verdict.NOT_GRADED


def test_thin_teeth_without_a_span_say_what_it_should_be(parts, named):
    mesh = parts.gear_mesh(
        teeth=40, module=2.5, helix_deg=20.0, width=10.0, shift=-0.2, tip_factor=1.2, roll_step=0.3
    )
    result = inspect(*mesh, named(teeth=40, module=2.5, helix_deg=20.0, accuracy_class=8))
    assert result.verdict is Verdict.OUT
    assert "span over 6 teeth not measurable (the span over 6 teeth of this helix" in result.findings[0]
    assert result.findings[0].endswith("wanted 42.264 mm")


@pytest.mark.parametrize(
    ("tip", "verdict"), [(44.0, Verdict.IN), (44.15, Verdict.IN), (44.3, Verdict.OUT), (43.7, Verdict.OUT)]
)
def test_tips_stand_where_they_were_named(spur, named, tip, verdict):
    result = inspect(*spur, named(accuracy_class=8, tip_diameter_mm=tip))
    assert result.verdict is verdict
    assert (f"tip 44.000 mm instead of {tip:g} mm" in result.findings) is (verdict is Verdict.OUT)


def test_two_bodies_side_by_side(spur, named):
    pair = beside(spur, spur, (100, 0, 0))
    for nominal in (None, named(accuracy_class=8), PolygonNominal(number_of_sides=6, across_flats_mm=17.0)):
        result = inspect(*pair, nominal)
        assert result.kind is None
        assert "2 separate bodies" in result.reason
        assert result.verdict is (Verdict.OUT if nominal else Verdict.NOT_GRADED)
    three = beside(pair, spur, (0, 0, 50))
    assert "3 separate bodies" in inspect(*three).reason
    vertices, faces = pair
    assert "2 separate bodies" in inspect(vertices, faces[:, ::-1]).reason


def test_bodies_that_meet_in_a_corner_are_two():
    cube = m3.Manifold.cube((10, 10, 10), True).to_mesh64()
    vertices = np.asarray(cube.vert_properties)[:, :3]
    faces = np.asarray(cube.tri_verts).astype(np.int64)
    pair = beside((vertices, faces), (vertices, faces), (10, 10, 10))
    joined, index = np.unique(pair[0], axis=0, return_inverse=True)
    assert len(joined) == 15
    assert "2 separate bodies" in inspect(joined, index.reshape(-1)[pair[1]]).reason


def test_bores_cavities_and_chips_are_no_bodies(parts, spur, named):
    assert inspect(*parts.gear_mesh(teeth=20, module=2.0, bore=12.0, z_step=5.0)).kind == "gear"
    ball = m3.Manifold.sphere(4.0, 32).translate((0, 0, -10)).to_mesh64()
    vertices = np.asarray(ball.vert_properties)[:, :3]
    faces = np.asarray(ball.tri_verts).astype(np.int64)
    hollow = beside(spur, (vertices, faces[:, ::-1]), (0, 0, 0))
    assert inspect(*hollow, named(accuracy_class=8)).verdict is Verdict.IN
    chip = beside(spur, (vertices * [0.1, 0.1, 0.1], faces), (30, 0, -9))
    assert inspect(*chip, named(accuracy_class=8)).verdict is Verdict.IN


@pytest.mark.parametrize(("scale", "size"), [(1e-3, "0.044 mm"), (1e3, "44000 mm")])
def test_wrong_units_without_a_nominal(spur, scale, size):
    vertices, faces = spur
    result = inspect(vertices * scale, faces)
    assert result.kind is None
    assert result.verdict is Verdict.NOT_GRADED
    assert f"20 teeth of normal module {2 * scale:g} mm on a largest diameter of {size}" in result.reason
    assert "units may be wrong" in result.reason
    assert "nominal" not in result.reason
    assert "wanted" not in result.reason


def test_nothing_is_wanted_where_nothing_was_named(parts, spur):
    hexagon = parts.polygon_mesh(across_flats=17.0, cutter_radius=40.0, inserts=2, sides=6)
    for mesh in (spur, hexagon, beside(spur, spur, (100, 0, 0))):
        result = inspect(*mesh)
        assert not any("wanted" in said for said in (*result.findings, result.reason))


@pytest.mark.parametrize("helix_deg", [0.0, 20.0, -20.0])
def test_perfect_gears_read_no_minus_nothing(parts, named, helix_deg):
    mesh = parts.gear_mesh(teeth=20, module=2.0, helix_deg=helix_deg, z_step=0.5, roll_step=0.1)
    for nominal in (None, named(helix_deg=helix_deg, accuracy_class=8)):
        result = inspect(*mesh, nominal)
        assert not re.search(r"-0\.0+(?![\d])", " ".join((*result.findings, *text_lines(result))))
