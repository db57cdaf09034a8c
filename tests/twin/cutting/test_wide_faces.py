"""The boolean with wide faces leaves what it leaves with fine ones."""

from itertools import pairwise

import manifold3d
import numpy as np
import pytest

from twin.cutting import stock
from twin.cutting.blank import Blank
from twin.cutting.dual import Surface
from twin.cutting.sheets import Sheets, widened
from twin.cutting.stock import blank_solid, solid, subtract

NI, NK = 61, 121


def groove(depth_x, wave=0.05):
    """A bar along z whose floor, at x = `depth_x` and wavy, is a sheet; its lid is far outside."""
    y, z = np.meshgrid(np.linspace(-4.0, 4.0, NI), np.linspace(-11.0, 1.0, NK), indexing="ij")
    floor = np.stack([depth_x + wave * np.sin(3.0 * y) * np.cos(2.0 * z), y, z], axis=-1)
    lid = np.stack([np.full_like(y, 15.0), y, z], axis=-1)
    number = np.arange(NI * NK).reshape(NI, NK)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    one, two = np.stack([a, c, b], axis=-1), np.stack([a, d, c], axis=-1)
    count = NI * NK
    low = np.concatenate([one.reshape(-1, 3), two.reshape(-1, 3)])
    rim = [*number[:, 0], *number[-1, 1:], *number[-2::-1, -1], *number[0, -2:0:-1]]
    walls = [
        face for p, q in pairwise([*rim, rim[0]]) for face in ((p, q, q + count), (p, q + count, p + count))
    ]
    faces = np.concatenate([low, low[:, ::-1] + count, walls])
    cells = np.arange((NI - 1) * (NK - 1)).reshape(NI - 1, NK - 1)
    # seen from inside the metal a sheet's cells run the other way: swap rows and columns
    sheets = Sheets(number.T[None], np.stack([cells, cells + cells.size], axis=-1).swapaxes(0, 1)[None])
    return Surface(np.concatenate([floor, lid]).reshape(-1, 3), faces, sheets=sheets)


def triangles(vertices, faces):
    """The triangles as a set, whatever the order of vertices and faces."""
    corners = vertices[faces]
    first = np.array([np.lexsort(corner.T[::-1])[0] for corner in corners])
    turned = np.stack([corners[np.arange(len(corners)), (first + k) % 3] for k in range(3)], axis=1)
    return {corner.tobytes() for corner in turned}


def by_manifold(blank, surface):
    """The boolean of the fine meshes, by manifold3d alone."""
    left = blank_solid(blank) - solid(surface.vertices, surface.faces, manifold3d.Manifold.reserve_ids(1))
    mesh = left.to_mesh64()
    return left, np.array(mesh.vert_properties[:, :3]), np.array(mesh.tri_verts, dtype=np.int64)


@pytest.mark.parametrize("wave", [0.0, 0.05])
def test_deep_sheets_are_widened_and_come_back_as_they_were(wave):
    blank, surface = Blank(diameter_mm=20.0, length_mm=10.0), groove(7.0, wave)
    made = widened(surface.vertices, surface.faces, surface.sheets, blank)
    assert len(made.replaced) > 0.7 * 2 * (NI - 1) * (NK - 1)
    assert len(surface.faces) - len(made.faces) > 0.9 * len(made.replaced)
    # the wide mesh is closed as well
    assert solid(surface.vertices, made.faces).volume() > 0
    left = stock._left(blank_solid(blank), [surface], [made])
    exact, vertices, faces = by_manifold(blank, surface)
    assert triangles(left.vertices, left.faces) == triangles(vertices, faces)
    remains = subtract(blank, surface)
    assert remains.volume_mm3 == pytest.approx(exact.volume(), rel=1e-12)
    assert remains.genus == exact.genus()
    # every face knows which of the fine ones it is a piece of
    own = left.origin >= 0
    normal = np.cross(
        *(left.vertices[left.faces[own][:, k]] - left.vertices[left.faces[own][:, 0]] for k in (1, 2))
    )
    plane = surface.vertices[surface.faces[left.origin[own]]]
    for corner in left.vertices[left.faces[own]].swapaxes(0, 1):
        assert np.abs(np.einsum("nx,nx->n", normal, corner - plane[:, 0])).max() < 1e-12
    assert set(made.replaced) <= set(left.origin)


def test_where_a_wide_face_meets_the_skin_the_fine_ones_are_taken():
    # the bore's wall stands in the way of some wide faces, not of the nodes that were looked at
    blank, surface = Blank(diameter_mm=20.0, length_mm=10.0, bore_mm=13.96), groove(7.0)
    made = widened(surface.vertices, surface.faces, surface.sheets, Blank(diameter_mm=20.0, length_mm=10.0))
    assert len(made.replaced)
    assert stock._left(blank_solid(blank), [surface], [made]) is None
    _, vertices, faces = by_manifold(blank, surface)
    whole = subtract(blank, surface)
    expected = stock.snapped(vertices, faces)
    assert triangles(whole.vertices, whole.faces) == triangles(expected[0], expected[1])


def test_a_step_of_the_blank_between_rows_keeps_them_fine():
    """The collar's shoulder stands between two rows: neither is inside at its own height alone."""
    surface = groove(7.0)
    z = float(np.unique(surface.vertices[:, 2])[60])
    narrow = ((0.0, 20.0), (z, 20.0), (z, 13.0), (z - 1e-3, 13.0), (z - 1e-3, 20.0), (-10.0, 20.0))
    whole, notched = (Blank(diameter_mm=20.0, length_mm=10.0, profile=p) for p in (None, narrow))
    assert len(widened(surface.vertices, surface.faces, surface.sheets, whole).replaced)
    assert not len(widened(surface.vertices, surface.faces, surface.sheets, notched).replaced)
