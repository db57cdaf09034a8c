"""A mesh that is closed in double precision is closed in the STL file, whatever falls together there."""

import numpy as np
import trimesh

from twin.output.meshes import write_stl


def test_vertices_that_fall_together_leave_no_gap(tmp_path):
    """A cube with one face's corner split in two, 1e-9 mm apart, and a fin without thickness on it."""
    cube = trimesh.creation.box()
    vertices = np.vstack([cube.vertices, cube.vertices[:1] + 1e-9, [[2.0, 2.0, 2.0]]])
    faces = np.array(cube.faces)
    corner = np.flatnonzero((faces == 0).any(axis=1))
    split = faces.copy()
    split[corner[0]] = np.where(split[corner[0]] == 0, 8, split[corner[0]])
    fin = [[0, 1, 9], [0, 9, 1]]
    write_stl(tmp_path / "part.stl", vertices, np.vstack([split, fin, [[0, 8, 1]]]))
    found = trimesh.load_mesh(tmp_path / "part.stl")
    assert found.is_watertight
    assert found.volume == 1.0
    assert len(found.faces) == 12
