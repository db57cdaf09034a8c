import math

import numpy as np
import pytest

from twin.inspection.deviation import deviation_map
from twin.inspection.inspection import inspect
from twin.inspection.nominal import PolygonNominal
from twin.inspection.result import Verdict
from twin.inspection.sheet import to_json

HEXAGON = {"across_flats": 17.0, "cutter_radius": 40.0, "inserts": 3, "sides": 6}

# geometry.md, section 3: S, R, inserts, Q, bow µm (+ convex), across corners mm, slope at the corner °
TABLE = [
    (17, 40, 3, 6, 13.04, 19.600, 0.305),
    (17, 40, 2, 6, -82.97, 19.822, 1.919),
    (17, 40, 1, 6, -194.5, 20.079, 4.44),
    (17, 40, 2, -6, -677, 21.194, 14.5),
    (10, 40, 2, 4, 8.63, 14.118, 0.198),
]


def hexagon(tolerance="h13", across_flats=17.0, sides=6):
    return PolygonNominal(number_of_sides=sides, across_flats_mm=across_flats, tolerance=tolerance)


@pytest.mark.parametrize("row", TABLE)
def test_table_of_turned_polygons(parts, row):
    s, r, inserts, sides, bow, corners, slope = row
    mesh = parts.polygon_mesh(across_flats=s, cutter_radius=r, inserts=inserts, sides=sides, width=10.0)
    found = inspect(*mesh).polygon
    assert found.number_of_sides == abs(sides)
    assert found.across_flats_mm == pytest.approx(s, abs=1e-4)
    digits = 0.5 if abs(bow) > 500 else 0.05 if abs(bow) > 100 else 0.005
    assert found.bow_um == pytest.approx(bow, abs=digits)
    assert found.across_corners_mm == pytest.approx(corners, abs=5e-4)
    assert found.across_corners_least_mm == pytest.approx(corners, abs=5e-4)
    # jaws rest on the middle of convex faces and on the corners of concave ones
    assert found.across_flats_caliper_mm == pytest.approx(s + 2 * max(-bow, 0) / 1000, abs=1.1e-3)
    assert found.across_flats_caliper_least_mm == pytest.approx(found.across_flats_caliper_mm, abs=1e-5)
    assert found.flatness_um == pytest.approx(abs(bow), rel=0.01)
    assert found.twist_deg_per_mm == pytest.approx(0.0, abs=1e-6)
    assert found.hand == "none"
    assert found.concentricity_um < 0.01
    np.testing.assert_allclose(found.angles_deg, 360 / abs(sides), atol=1e-4)
    # the section itself, at the corner: an edge of the outline leans by the table's slope to the face
    edges = np.diff(found.section, axis=0)
    edges = edges[np.hypot(*edges.T) > 1e-6]
    tilt = np.degrees(np.arctan2(edges[:, 1], edges[:, 0])) - 90.0 - found.faces[0].direction_deg
    lean = np.abs(np.mod(tilt + 180 / abs(sides), 360 / abs(sides)) - 180 / abs(sides))
    assert lean.max() == pytest.approx(slope, rel=0.015)


def test_plain_planes_lie_two_thirds_of_a_slight_bow_below_mid_face(parts):
    """The mean of a parabola is a third of its height below the vertex."""
    found = inspect(*parts.polygon_mesh(**HEXAGON, width=10.0)).polygon
    lower = 1000 * (found.across_flats_mm - found.across_flats_planes_mm)
    assert lower == pytest.approx(2 / 3 * found.bow_um, rel=0.02)


@pytest.mark.parametrize("twist", [2.0, -0.5])
def test_twist_and_its_hand(parts, twist):
    mesh = parts.polygon_mesh(**HEXAGON, twist_deg_per_mm=twist, phase_deg=11.0, z_step=0.1, width=10.0)
    found = inspect(*mesh).polygon
    assert found.twist_deg_per_mm == pytest.approx(twist, rel=1e-4)
    assert found.hand == ("right" if twist > 0 else "left")
    assert found.bow_um == pytest.approx(13.04, rel=0.02)
    assert found.across_flats_mm == pytest.approx(17.0, abs=1e-3)
    # the part is turned about its middle, so that mid-length keeps its phase
    assert found.faces[0].direction_deg == pytest.approx(11.0, abs=1e-3)


def test_faces_are_read_where_the_blank_left_them(parts):
    """A bar too thin for the corners: shorter faces, less bow, corners on the bar's circle."""
    bar = 19.2
    mesh = parts.polygon_mesh(**HEXAGON, blank_diameter=bar, points=800, width=10.0)
    found = inspect(*mesh).polygon
    full = parts.polygon_face(17.0, 40.0, 3, 6, 40001)
    face = full[np.abs(full) <= bar / 2]
    assert found.across_corners_mm == pytest.approx(bar, abs=1e-4)
    assert found.bow_um == pytest.approx(1000 * (face.real.max() - face.real.min()), rel=0.01)
    assert found.across_flats_mm == pytest.approx(17.0, abs=1e-4)


def test_off_axis_polygon(parts):
    """The axis of the faces 0.05 mm off the work axis: a zone of 0.1 mm, widths as before."""
    found = inspect(*parts.polygon_mesh(**HEXAGON, offset=(0.03, 0.04), bore=5.0, width=10.0)).polygon
    assert found.concentricity_um == pytest.approx(100.0, abs=0.1)
    assert found.across_flats_mm == pytest.approx(17.0, abs=1e-4)
    assert found.across_flats_caliper_mm == pytest.approx(17.0, abs=1e-3)
    assert found.across_corners_mm == pytest.approx(19.600, abs=1e-3)


@pytest.mark.parametrize("sides", [3, 5])
def test_odd_polygons_have_no_caliper_width(parts, sides):
    mesh = parts.polygon_mesh(
        across_flats=20.0, cutter_radius=40.0, inserts=sides, sides=2 * sides, width=5.0
    )
    even = inspect(*mesh)
    assert even.unmeasured == {}
    mesh = parts.polygon_mesh(across_flats=20.0, cutter_radius=400.0, inserts=1, sides=sides, width=5.0)
    odd = inspect(*mesh)
    assert odd.polygon.number_of_sides == sides
    assert odd.polygon.across_flats_caliper_mm is None
    assert "no face stands opposite" in odd.unmeasured["across_flats_caliper_mm"]
    assert odd.polygon.across_flats_mm == pytest.approx(20.0, abs=5e-3)


def test_convex_hexagon_is_in_and_the_original_example_is_out(parts):
    convex = inspect(*parts.polygon_mesh(**HEXAGON), hexagon())
    assert convex.verdict is Verdict.IN
    concave = inspect(*parts.polygon_mesh(**HEXAGON | {"inserts": 2}), hexagon())
    assert concave.verdict is Verdict.OUT
    assert concave.polygon.across_flats_caliper_mm == pytest.approx(17.166, abs=5e-4)
    assert concave.findings[0].startswith("too large: 17.166 mm across flats by caliper")
    assert "concave by 83.0 µm" in concave.findings[1]


@pytest.mark.parametrize(
    ("size", "verdict"),
    [
        (17.0, Verdict.IN),
        (17.0004, Verdict.IN),
        (17.0016, Verdict.OUT),
        (16.7306, Verdict.IN),
        (16.728, Verdict.OUT),
    ],
)
def test_h13_after_rounding_to_a_micrometre(parts, size, verdict):
    assert inspect(*parts.polygon_mesh(**HEXAGON | {"across_flats": size}), hexagon()).verdict is verdict


def test_corners_cut_too_far_are_out(parts):
    """e_min = 1.13 s_min = 18.905 mm at 17 h13."""
    good, bad = (
        inspect(*parts.polygon_mesh(**HEXAGON, blank_diameter=d, points=400), hexagon())
        for d in (18.92, 18.89)
    )
    assert good.verdict is Verdict.IN
    assert bad.verdict is Verdict.OUT
    assert bad.findings[0].startswith("corners too small: 18.890 mm")


def test_wrong_number_of_sides_gives_no_figures(parts):
    mesh = parts.polygon_mesh(**HEXAGON)
    result = inspect(*mesh, hexagon(sides=8))
    assert result.kind is None
    assert result.verdict is Verdict.OUT
    assert result.reason.endswith("a polygon with 6 sides was found, not 8")


def test_map_of_a_hexagon_is_its_bow(parts):
    vertices, faces = parts.polygon_mesh(**HEXAGON, z_step=1.0)
    result = inspect(vertices, faces, hexagon())
    value = deviation_map(vertices, faces, result)
    assert np.nanmax(value) == pytest.approx(0.0, abs=0.01)
    assert np.nanmin(value) == pytest.approx(-13.04, abs=0.01)
    # only the two middles of the ends belong to no face
    assert np.count_nonzero(np.isnan(value)) == 2


def test_keys_of_the_result(parts):
    values = to_json(inspect(*parts.polygon_mesh(**HEXAGON), hexagon()))
    wanted = {
        "kind", "number_of_sides", "across_flats_mm", "across_flats_caliper_mm", "across_corners_mm",
        "bow_um", "flatness_um", "twist_deg_per_mm", "hand", "verdict",
    }  # fmt: skip
    assert wanted <= values.keys()
    assert values["kind"] == "polygon"
    assert math.isclose(values["across_flats_mm"], 17.0, abs_tol=1e-4)
