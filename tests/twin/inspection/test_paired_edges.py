"""The faces on both sides of every edge, from a table of the edges of each face."""

import numpy as np
import pytest
import trimesh

from twin.inspection import solid
from twin.inspection.solid import MeshError


def table(faces):
    """Edge from its lower to its higher vertex -> the face that passes it so, and the one that comes back."""
    found = {}
    for face, corners in enumerate(faces.tolist()):
        for start, end in zip(corners, corners[1:] + corners[:1], strict=True):
            found.setdefault((min(start, end), max(start, end)), [-1, -1])[int(start > end)] = face
    return [tuple(found[edge]) for edge in sorted(found)]


@pytest.mark.parametrize("vertices", [10_000, 1 << 31])
def test_every_edge_has_the_face_that_rises_along_it_and_the_one_that_falls(vertices):
    """Also where numbers of vertices are too large for one sort of edges with their faces."""
    ball = trimesh.creation.icosphere(subdivisions=3)
    number = np.sort(np.random.default_rng(0).choice(vertices, len(ball.vertices), replace=False))
    faces = number[np.asarray(ball.faces)]
    assert (solid._paired(faces, vertices) is None) == (vertices > 10_000)
    first, second = solid._neighbours(faces, vertices)
    assert list(zip(first.tolist(), second.tolist(), strict=True)) == table(faces)


def test_what_is_open_turned_or_doubled_has_no_pairs():
    faces = np.asarray(trimesh.creation.icosphere(subdivisions=1).faces)
    turned = np.concatenate([faces[:1, ::-1], faces[1:]])
    for bad in (faces[1:], faces[2:], turned, np.concatenate([faces, faces[:2]])):
        assert solid._paired(bad, 42) is None
        with pytest.raises(MeshError):
            solid._neighbours(bad, 42)
