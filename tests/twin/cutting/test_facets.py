"""Facets of the general way: closed however they are divided, and nowhere further off than promised."""

import math
from dataclasses import replace

import numpy as np
import pytest
from rays import deepest

from twin.cutters.hob import Hob
from twin.cutters.polygon_head import PolygonHead
from twin.cutting.blank import Blank
from twin.cutting.cut import cut
from twin.cutting.field import DepthField
from twin.cutting.parting import across, are_joined, parted, turned
from twin.cutting.plan import facet_limit

HOB = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, gashes=8)
SHARP = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, gashes=8, tip_radius_factor=0.0)
GEAR = Blank(diameter_mm=24.0, length_mm=2.5, bore_mm=6.0)
LONG = Blank(diameter_mm=24.0, length_mm=14.0, bore_mm=6.0)
BAR = Blank(diameter_mm=19.0, length_mm=3.0)
POINTS = 3000


def hobbing(synthetic, hob=HOB, *, z_end=-19.0, feed=2.0, **more):
    return synthetic.hobbing(hob, teeth=10, tip_x=7.5, z=(14.0, z_end), feed=feed, step_deg=6.0, **more)


def square_at_twice_the_speed(synthetic):
    """Inserts with sharp corners that turn a pattern of many flats, past a shoulder."""
    head = PolygonHead(inserts=3, tip_radius_mm=40.0)
    return synthetic.polygon_turning(
        head, ratio=3, across_flats=15.0, work_turns=8, z=(2.0, -1.5), step_deg=2.0
    )


def stepped_inserts(synthetic):
    """Shoulders square to the work axis, feet below them: edges that one insert has itself."""
    profile = ((0.4, 0.0), (0.4, 0.5), (1.0, 0.5), (1.0, 2.0))
    head = PolygonHead(inserts=2, tip_radius_mm=40.0, profile=profile)
    return synthetic.polygon_turning(
        head, ratio=6, across_flats=16.5, work_turns=6, z=(2.0, -1.5), step_deg=2.0
    )


def two_teeth_too_many(synthetic):
    """Gaps that overlap: walls thinner than a cell between them."""
    return hobbing(synthetic, ratio_factor=10.0 / 12.0)


def without_differential(synthetic):
    """Sharp tips that cut notches into each other's flanks: edges of one bite across others' ridges."""
    cutter, motion = hobbing(synthetic, SHARP, helix_deg=15.0)
    return cutter, replace(motion, work_angle=motion.tool_angle / 10.0)


JOBS = {
    "the wrong hand": (GEAR, lambda s: hobbing(s, ratio_factor=-1.0), 0.35),
    "the wrong hand, sharp tips": (GEAR, lambda s: hobbing(s, SHARP, ratio_factor=-1.0), 0.35),
    "stopped halfway": (LONG, lambda s: hobbing(s, z_end=-1.0), 0.45),
    "a coarse feed": (GEAR, lambda s: hobbing(s, feed=9.0, ratio_factor=1.1), 0.35),
    "polygon with a shoulder": (BAR, square_at_twice_the_speed, 0.3),
    "stepped inserts": (BAR, stepped_inserts, 0.2),
    "thin walls": (GEAR, two_teeth_too_many, 0.3),
    "no differential, sharp tips": (GEAR, without_differential, 0.3),
}


@pytest.mark.parametrize("name", JOBS)
def test_no_point_of_a_facet_stands_further_off_than_promised(name, synthetic):
    blank, job, cell = JOBS[name]
    cutter, motion = job(synthetic)
    result = cut(blank, ((cutter, motion),), cell_mm=cell)
    assert result.method.startswith("general")
    limit = facet_limit(blank, [cutter], cell_mm=cell)
    part = result.remains
    corners = part.vertices[part.faces]
    rng = np.random.default_rng(7)
    points = np.einsum("nc,ncx->nx", rng.dirichlet(np.ones(3), len(corners)), corners)
    r, (low, _) = np.hypot(*points[:, :2].T), blank.z_range
    inner = (r < blank.radius - 2e-3) & (2.0 * r > blank.bore_mm + 2e-3)
    points = points[inner & (points[:, 2] < -1e-3) & (points[:, 2] > low + 1e-3)]
    points = points[rng.choice(len(points), min(POINTS, len(points)), replace=False)]
    depth, _ = deepest(DepthField(cutter, motion, blank.radius, blank.z_range), points)
    assert np.abs(depth).max() < limit
    # the ridges would stand out far further on facets that cross them: most of the mesh is none
    assert np.median(np.abs(depth)) < 0.5 * limit
    assert not [note for note in result.notes if "between its vertices" in note]


def test_a_tolerance_scales_what_is_promised():
    cutter = HOB.cutter(0.0)
    assert facet_limit(GEAR, [cutter]) == 2e-3
    assert facet_limit(GEAR, [cutter], tolerance_um=0.25) == 5e-4
    wide = facet_limit(GEAR, [cutter], cell_mm=0.4)
    assert facet_limit(GEAR, [cutter], cell_mm=0.2) == pytest.approx(wide / 4.0)


def torus(around=12, across=8):
    """Vertices and triangles of a torus, counter-clockwise seen from outside."""
    u, v = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = 2 * math.pi * u.ravel() / around, 2 * math.pi * v.ravel() / across
    r = 3.0 + np.cos(b)
    vertices = np.column_stack([r * np.cos(a), r * np.sin(a), np.sin(b)])

    def at(i, j):
        return ((u + i) % around * across + (v + j) % across).ravel()

    one, two = (at(0, 0), at(1, 0), at(1, 1)), (at(0, 0), at(1, 1), at(0, 1))
    return vertices, np.vstack([np.column_stack(one), np.column_stack(two)])


def directed(faces):
    return list(zip(faces.ravel().tolist(), np.roll(faces, -1, axis=1).ravel().tolist(), strict=True))


def test_sides_are_found_from_both_of_their_facets():
    _, faces = torus()
    rows = {side: divmod(at, 3) for at, side in enumerate(directed(faces))}
    ends = np.array(list(rows))
    facets, corners = across(faces, ends)
    assert facets.tolist() == [row for row, _ in rows.values()]
    assert corners.tolist() == [faces[row, (k + 2) % 3] for row, k in rows.values()]
    # on a torus without one of its facets
    facets, corners = across(faces[1:], ends[:3])
    assert (facets == -1).all()
    assert (corners == -1).all()
    every = np.stack(np.triu_indices(int(faces.max()) + 1, 1), axis=1)
    joined = are_joined(faces, every)
    assert set(map(tuple, every[joined].tolist())) == {tuple(sorted(side)) for side in rows}


def test_turned_sides_leave_a_closed_mesh():
    vertices, faces = torus()
    # sides of which no two are on one facet
    ends = faces[: len(faces) // 2 : 8, :2]
    facets, corners = (
        np.stack(pair, axis=1) for pair in zip(across(faces, ends), across(faces, ends[:, ::-1]), strict=True)
    )
    assert len(np.unique(facets)) == facets.size
    new = turned(faces, ends, facets, corners)
    sides = directed(new)
    assert len(set(sides)) == len(sides)
    assert set(sides) == {(b, a) for a, b in sides}
    gone, made = (set(map(tuple, np.sort(pairs, axis=1).tolist())) for pairs in (ends, corners))
    assert {tuple(sorted(side)) for side in sides} == {
        tuple(sorted(side)) for side in directed(faces)
    } - gone | made
    # what turning a side adds is the tetrahedron between the old diagonal and the new one
    a, b, c, d = (vertices[v] for v in (*ends.T, *corners.T))
    between = np.einsum("nx,nx->n", np.cross(b - a, c - a), d - a).sum() / 6.0
    assert volume(vertices, new) - volume(vertices, faces) == pytest.approx(between, rel=1e-9)


def volume(vertices, faces):
    a, b, c = vertices[faces].transpose(1, 0, 2)
    return np.einsum("nx,nx->", a, np.cross(b, c)) / 6.0


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9, 1.0])
def test_a_closed_mesh_stays_closed_and_the_same_solid(share):
    vertices, faces = torus()
    rng = np.random.default_rng(3)
    sides = np.unique(np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)), axis=0)
    chosen = sides[rng.permutation(len(sides))[: round(share * len(sides))]]
    new_faces, new = parted(faces, chosen, len(vertices))
    at = rng.uniform(0.1, 0.9, (len(chosen), 1))
    points = np.vstack([vertices, vertices[chosen[:, 0]] * at + vertices[chosen[:, 1]] * (1.0 - at)])
    start, end = new_faces.ravel(), np.roll(new_faces, -1, axis=1).ravel()
    directed = set(zip(start.tolist(), end.tolist(), strict=True))
    assert len(directed) == len(start)
    assert directed == {(b, a) for a, b in directed}
    # a torus still: V - E + F = 0, and every side that was chosen is gone
    assert len(points) - len(directed) // 2 + len(new_faces) == 0
    assert not directed & set(map(tuple, chosen.tolist()))
    assert volume(points, new_faces) == pytest.approx(volume(vertices, faces), rel=1e-12)
    area = np.linalg.norm(
        np.cross(*(points[new_faces[:, k]] - points[new_faces[:, 0]] for k in (1, 2))), axis=1
    )
    assert (area > 0).all()
    kept = np.setdiff1d(np.arange(len(new_faces)), new)
    assert {tuple(face) for face in new_faces[kept].tolist()} <= {tuple(face) for face in faces.tolist()}
