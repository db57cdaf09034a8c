"""A cut part is closed in every file, as a reader sees it that joins equal vertices of single precision."""

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from twin.cutting import snapping
from twin.cutting.snapping import grid_step, snapped
from twin.cutting.stock import lathe
from twin.output.meshes import write_3mf, write_glb, write_stl

WRITERS = {"stl": (write_stl, 1.0), "glb": (write_glb, 1000.0), "3mf": (write_3mf, 1.0)}
"""suffix -> writer, millimetres of its unit"""


def as_read(path, unit):
    """The file's triangles, vertices joined that are equal in single precision."""
    found = trimesh.load_mesh(path, process=False)
    corners = np.asarray(found.vertices, dtype=np.float32)[found.faces].reshape(-1, 3)
    places, number = np.unique(corners, axis=0, return_inverse=True)
    return places.astype(np.float64) * unit, number.reshape(-1, 3)


def assert_closed(faces):
    """Every directed edge once, and once its opposite."""
    edges = np.stack([faces.ravel(), np.roll(faces, -1, axis=1).ravel()], axis=1)
    there, back = (np.unique(e, axis=0) for e in (edges, edges[:, ::-1]))
    assert len(there) == len(edges)
    assert np.array_equal(there, back)


def volume(vertices, faces):
    a, b, c = vertices[faces].transpose(1, 0, 2)
    return np.einsum("ni,ni->", a, np.cross(b, c)) / 6


def split_apart(vertices, faces, rng, apart):
    """The mesh with a quarter of its edges split twice, `apart` from each other: slivers as ridges make."""
    for _ in range(len(vertices) // 4):
        at = rng.integers(len(faces))
        a, b, c = faces[at]
        other = np.flatnonzero(((faces == b) & (np.roll(faces, -1, axis=1) == a)).any(axis=1))[0]
        d = next(v for v in faces[other] if v not in (a, b))
        m, n = len(vertices), len(vertices) + 1
        middle = (vertices[a] + vertices[b]) / 2
        vertices = np.vstack([vertices, middle, middle + apart * rng.normal(size=3)])
        new = [[a, m, c], [m, n, c], [n, b, c], [b, n, d], [n, m, d], [m, a, d]]
        faces = np.vstack([np.delete(faces, [at, other], axis=0), new])
    return vertices, faces


def tangled(vertices, faces, rng, spread, times):
    """The mesh with one facet split into a tangle of vertices about `spread` from its first corner."""
    vertices, faces, open_ = list(vertices), [tuple(face) for face in faces], [0]
    at = vertices[faces[0][0]]
    for _ in range(times):
        k = open_[rng.integers(len(open_))]
        (a, b, c), m = faces[k], len(vertices)
        vertices.append(at + spread * rng.normal(size=3))
        open_ += [len(faces), len(faces) + 1]
        faces[k] = a, b, m
        faces += [(b, c, m), (c, a, m)]
    return np.array(vertices), np.array(faces)


@pytest.mark.parametrize("spread", [0.5, 1.0, 2.0])
def test_a_tangle_far_below_single_precision_is_parted(spread):
    """Some 1500 vertices within a few grid steps: where slivers meet that the boolean has left."""
    ball = trimesh.creation.icosphere(subdivisions=1, radius=10.0)
    step = grid_step(ball.vertices)
    mesh = tangled(ball.vertices, ball.faces, np.random.default_rng(3), spread * step, 1500)
    vertices, faces, _ = snapped(*mesh)
    assert_closed(faces)
    assert volume(vertices, faces) == pytest.approx(ball.volume, rel=1e-6)


def test_solids_that_touch_with_a_corner_stay_two():
    """Joined there, one vertex would stand for two fans of faces."""
    one, two = (trimesh.creation.box(bounds=bounds) for bounds in ([[0] * 3, [1] * 3], [[1] * 3, [2] * 3]))
    vertices = np.vstack([one.vertices, two.vertices + 1e-9])
    faces = np.vstack([one.faces, two.faces + 8])
    vertices, faces, _ = snapped(vertices, faces)
    assert_closed(faces)
    assert len(np.unique(vertices, axis=0)) == len(vertices) == 16


@pytest.mark.parametrize("suffix", WRITERS)
@pytest.mark.parametrize("size", [0.3, 7.9, 63.99, 64.0, 127.9, 1999.0])
def test_slivers_below_single_precision_leave_no_gap(tmp_path, suffix, size):
    """Sizes on either side of powers of two, where single precision is finest and coarsest against metres."""
    ball = trimesh.creation.icosphere(subdivisions=2, radius=size)
    rng = np.random.default_rng(3)
    step = grid_step(ball.vertices)
    vertices, faces = split_apart(np.array(ball.vertices), np.array(ball.faces), rng, apart=0.2 * step)
    assert_closed(faces)
    writer, unit = WRITERS[suffix]
    writer(tmp_path / f"part.{suffix}", *snapped(vertices, faces)[:2])
    points, found = as_read(tmp_path / f"part.{suffix}", unit)
    assert_closed(found)
    assert len(found) < len(faces)
    assert volume(points, found) == pytest.approx(volume(vertices, faces), rel=1e-5 / size + 1e-6)


@given(
    st.floats(1e-3, 1e5),
    st.lists(st.integers(-(2**23) + 2, 2**23 - 2), min_size=1, max_size=20),
)
def test_single_precision_tells_points_of_the_grid_apart_in_millimetres_and_in_metres(size, places):
    step = grid_step(np.array([[size, 0.0, -size / 3]]))
    inside = np.array([k for k in places if abs(k) * step <= size] or [0], dtype=np.float64)
    assert np.array_equal((inside * step).astype(np.float32), inside * step)
    for unit in (1.0, 1000.0):
        here, there = ((inside + k) * step / unit for k in (0, 1))
        assert (here.astype(np.float32) < there.astype(np.float32)).all()


def touching_bars():
    """Two bars of square section that touch along an edge, each with vertices of its own."""
    bar = lathe(np.array([[1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]]), 4).to_mesh64()
    points, faces = bar.vert_properties[:, :3], np.array(bar.tri_verts, dtype=np.int64)
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    one = points + np.array([1.0, 0.0, 0.0])
    return np.vstack([one, one @ (turn @ turn).T]), np.vstack([faces, faces + len(points)])


def test_bars_that_touch_along_an_edge_stay_apart():
    """Joined, four faces would meet at the edge, and no file could say which belong together."""
    vertices, faces = touching_bars()
    joined = np.unique(vertices.round(6) + 0.0, axis=0, return_inverse=True)[1].reshape(-1)[faces]
    with pytest.raises(AssertionError):
        assert_closed(joined)
    points, found, kept = snapped(vertices, faces)
    again = np.unique(points.astype(np.float32), axis=0, return_inverse=True)[1].reshape(-1)[found]
    assert_closed(again)
    assert np.abs(points - points.round(2)).max() <= 2 * grid_step(vertices)
    # drawn apart, not into each other
    assert volume(points, found) < volume(vertices, faces)
    assert kept.tolist() == list(range(len(faces)))


def test_bars_of_air_that_touch_along_an_edge_stay_apart():
    """The same turned inside out within a block."""
    block = trimesh.creation.box(extents=(8.0, 8.0, 8.0))
    vertices, faces = touching_bars()
    vertices = np.vstack([vertices, block.vertices])
    faces = np.vstack([faces[:, ::-1], np.array(block.faces) + len(vertices) - 8])
    points, found, kept = snapped(vertices, faces)
    again = np.unique(points.astype(np.float32), axis=0, return_inverse=True)[1].reshape(-1)[found]
    assert_closed(again)
    assert volume(points, found) > volume(vertices, faces)
    assert kept.tolist() == list(range(len(faces)))


def wedge(low, high):
    """A bar along the z axis between two angles about it, its edge on the axis [rad]."""
    section = [[0.0, 0.0], [np.cos(low), np.sin(low)], [np.cos(high), np.sin(high)]]
    points = np.array([[*corner, z] for z in (0.0, 0.3, 1.0) for corner in section])
    sides = [
        [a, b, b + 3, a, b + 3, a + 3] for z in (0, 3) for a, b in ((z, z + 1), (z + 1, z + 2), (z + 2, z))
    ]
    return points, np.vstack([np.array(sides).reshape(-1, 3), [[0, 2, 1], [6, 7, 8]]])


def test_wedges_that_lie_on_the_same_side_stay_apart():
    """Both are drawn the same way, which does not part them."""
    (one, faces), (other, _) = wedge(1.05, 1.45), wedge(1.7, 2.1)
    vertices, faces = np.vstack([one, other]), np.vstack([faces, faces + len(one)])
    assert volume(vertices, faces) > 0
    points, found, kept = snapped(vertices, faces)
    again = np.unique(points.astype(np.float32), axis=0, return_inverse=True)[1].reshape(-1)[found]
    assert_closed(again)
    assert kept.tolist() == list(range(len(faces)))
    assert np.abs(points[found] - vertices[faces]).max() <= 3 * grid_step(vertices)


def test_a_fin_without_thickness_goes():
    cube = trimesh.creation.box()
    vertices = np.vstack([cube.vertices, [[2.0, 2.0, 2.0], [2.0, 2.0, 2.0 + 1e-9]]])
    fin = [[0, 1, 8], [0, 8, 9], [0, 9, 1], [1, 9, 8]]
    points, found, kept = snapped(vertices, np.vstack([cube.faces, fin]))
    assert_closed(found)
    assert len(found) == 12
    assert kept.tolist() == list(range(12))
    assert len(points) == 8
    assert volume(points, found) == 1.0


def test_a_mesh_on_the_grid_comes_back_as_it_was():
    cube = trimesh.creation.box()
    points, found, kept = snapped(np.array(cube.vertices), np.array(cube.faces))
    again = snapped(points, found)
    assert np.array_equal(again[0], points)
    assert np.array_equal(again[1], found)
    assert kept.tolist() == again[2].tolist() == list(range(12))
    assert volume(points, found) == 1.0


def test_vertices_apart_keep_their_order_also_where_their_places_mix_alike(monkeypatch):
    """Which places are the same is told by sums of their coordinates first, which may agree by chance."""
    ball = trimesh.creation.icosphere(subdivisions=3, radius=10.0)
    vertices, faces = np.array(ball.vertices), np.array(ball.faces)
    expected = snapped(vertices, faces)
    assert np.abs(expected[0] - vertices).max() <= 0.5 * grid_step(vertices)
    assert np.array_equal(expected[1], faces)
    monkeypatch.setattr(snapping, "MIXED", np.array([1, 0, 0], dtype=np.uint64))
    for one, other in zip(snapped(vertices, faces), expected, strict=True):
        assert np.array_equal(one, other)
