"""Twisted polygons against analytic ones, and against the stairs a straight insert leaves (G51.2 with A)."""

import math

import manifold3d as m3
import numpy as np
import pytest

from twin.inspection.inspection import inspect
from twin.inspection.nominal import PolygonNominal
from twin.inspection.result import Verdict
from twin.inspection.text import text_lines

HEXAGON = {"across_flats": 17.0, "cutter_radius": 40.0, "inserts": 3, "sides": 6, "width": 8.0}
NOMINAL = PolygonNominal(number_of_sides=6, across_flats_mm=17.0)
# of the facets: chords over a layer of h mm lie inside the twisted face by up to 8.5 (1 - cos(3.6° h / 2))
MESHES = [(0.05, 200, 2e-4, 0.05), (0.15, 60, 1e-3, 0.2), (0.3, 34, 3e-3, 0.4)]


@pytest.mark.parametrize("twist", [3.6, -3.6])
@pytest.mark.parametrize(("z_step", "points", "size", "bow"), MESHES)
def test_twisted_hexagon(parts, twist, z_step, points, size, bow):
    mesh = parts.polygon_mesh(**HEXAGON, twist_deg_per_mm=twist, z_step=z_step, points=points, phase_deg=7.0)
    found = inspect(*mesh).polygon
    assert found.range_mm == pytest.approx((-8.0, 0.0))
    assert found.twist_deg_per_mm == pytest.approx(twist, rel=1e-3)
    assert found.hand == ("right" if twist > 0 else "left")
    assert found.across_flats_mm == pytest.approx(17.0, abs=size)
    assert found.across_flats_caliper_mm == pytest.approx(17.0, abs=size)
    assert found.across_corners_mm == pytest.approx(19.5998, abs=size)
    assert found.bow_um == pytest.approx(13.04, abs=bow)
    assert found.flatness_um == pytest.approx(13.04, abs=3 * bow)
    for face in found.faces:
        assert face.twist_deg_per_mm == pytest.approx(twist, rel=1e-3)
    assert found.concentricity_um < 0.5


def stairs(parts, *, twist, feed, edge, seed):
    """Each section is what all passes of the edge leave: plain cuts, one step of each face per work turn.

    Vertices lie at random, as a cutting grid leaves them, on layers about 0.1 mm apart.
    """
    rng = np.random.default_rng(seed)
    layers = np.linspace(-8.0, 0.0, 81)
    layers[1:-1] += rng.uniform(-0.03, 0.03, 79)
    grid = np.linspace(-math.pi, math.pi, 540, endpoint=False)
    turns = np.arange(-40, 20)
    rings = []
    for z in layers:
        angle = grid + rng.uniform(-0.3, 0.3) * (grid[1] - grid[0])
        # a point of the work is met once a turn; the cuts of one turn lie as the edge's middle has moved on
        middle = feed * (turns[:, None] + angle / (2 * math.pi))
        met = np.abs(z - middle) <= edge / 2
        radius = np.full(len(angle), np.inf)
        for face in range(-1, 7):
            # the face as it is cut about its own middle, by the insert's turn there
            away = angle - math.radians(60.0 * face - 180.0)
            lean = away - math.radians(twist) * middle
            cut = np.where(met & (np.abs(lean) < 1.2), 8.5 / np.cos(np.clip(lean, -1.2, 1.2)), np.inf)
            radius = np.minimum(radius, cut.min(axis=0))
        rings.append(
            np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.full(len(angle), z)])
        )
    return parts.loft(rings)


@pytest.mark.parametrize("seed", [1, 2])
def test_stairs_of_a_straight_insert(parts, seed):
    """2 mm of edge at 0.5 mm a turn: every section is what 4 cuts 1.8° apart leave, all the way along."""
    mesh = stairs(parts, twist=3.6, feed=0.5, edge=2.0, seed=seed)
    found = inspect(*mesh, NOMINAL).polygon
    assert found.number_of_sides == 6
    assert found.range_mm == pytest.approx((-8.0, 0.0))
    assert found.twist_deg_per_mm == pytest.approx(3.6, rel=1e-3)
    # no cut comes nearer than 8.5 mm, and between the cuts little more is left
    assert found.across_flats_mm == pytest.approx(17.0, abs=6e-3)
    # the outer cuts of neighbouring faces lie 60° - 3 x 1.8° apart, now and then 60° - 4 x 1.8°
    assert (
        17.0 / math.cos(math.radians(26.4)) - 0.01
        < found.across_corners_mm
        < 17.0 / math.cos(math.radians(27.3))
    )


def test_twist_is_out_where_plain_faces_are_wanted(parts):
    twisted = inspect(*parts.polygon_mesh(**HEXAGON, twist_deg_per_mm=-3.6, z_step=0.1), NOMINAL)
    assert twisted.verdict is Verdict.OUT
    assert twisted.findings[0] == (
        "the faces are twisted by 3.600 °/mm left-hand, 28.8° over 8.00 mm: plain faces are wanted"
    )
    # 0.4° and 0.6° over the length
    for twist, verdict in ((0.05, Verdict.IN), (0.075, Verdict.OUT)):
        mesh = parts.polygon_mesh(**HEXAGON, twist_deg_per_mm=twist, z_step=0.5)
        assert inspect(*mesh, NOMINAL).verdict is verdict
    untold = inspect(*parts.polygon_mesh(**HEXAGON, twist_deg_per_mm=-3.6, z_step=0.1))
    assert untold.verdict is Verdict.NOT_GRADED


@pytest.mark.parametrize("phase_deg", [0.0, 13.0, 30.0])
def test_nothing_reads_as_minus_nothing(parts, phase_deg):
    angle = np.radians(phase_deg + 60.0 * np.arange(6))
    corner = 17.0 / math.sqrt(3) * np.column_stack([np.cos(angle), np.sin(angle)])
    sides = zip(corner, np.roll(corner, -1, axis=0), strict=True)
    ring = np.concatenate([np.linspace(a, b, 20, endpoint=False) for a, b in sides])
    mesh = parts.loft([np.column_stack([ring, np.full(len(ring), z)]) for z in np.linspace(-8, 0, 9)])
    result = inspect(*mesh, NOMINAL)
    assert result.verdict is Verdict.IN
    assert (result.polygon.bow_um, result.polygon.twist_deg_per_mm) == (0.0, 0.0)
    said = " ".join((*result.findings, *text_lines(result)))
    assert "-0.0" not in said
    assert "concave" not in said


@pytest.mark.parametrize(("sides", "pieces"), [(4, 1), (6, 1), (5, 1), (6, 3)])
def test_a_prism_of_few_large_facets_is_a_polygon(sides, pieces):
    """A CAD export has one quadrilateral a face: its chords are as long as the faces."""
    prism = m3.Manifold.cylinder(10.0, 9.0, 9.0, sides, True).refine(pieces).translate((0, 0, -5))
    mesh = prism.to_mesh64()
    found = inspect(np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts).astype(np.int64))
    assert found.kind == "polygon"
    assert found.polygon.number_of_sides == sides
    assert found.polygon.across_flats_mm == pytest.approx(18 * math.cos(math.pi / sides), abs=1e-4)
    assert found.polygon.bow_um == pytest.approx(0, abs=0.05)
