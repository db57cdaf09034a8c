"""Every format in the unit it declares, and every file that cannot be measured."""

import gzip
import re
import zipfile

import numpy as np
import pytest
import trimesh

from twin.errors import InputError
from twin.inspection.mesh_files import joined, read_mesh
from twin.inspection.solid import check_solid

PER_UNIT = {
    "micron": 0.001,
    "millimeter": 1.0,
    "centimeter": 10.0,
    "meter": 1000.0,
    "inch": 25.4,
    "foot": 304.8,
}


@pytest.fixture(scope="module")
def gear(parts):
    return parts.gear_mesh(teeth=12, module=2.0, width=5.0, z_step=5.0, roll_step=0.5)


def saved(mesh, path, scale=1.0, **words):
    vertices, faces = mesh
    trimesh.Trimesh(np.asarray(vertices) * scale, faces, process=False).export(path, **words)
    return path


def volume(mesh):
    a, b, c = (mesh[0][mesh[1][:, i]] for i in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


@pytest.mark.parametrize(
    ("name", "scale", "words"),
    [
        ("a.stl", 1.0, {}),
        ("a.STL", 1.0, {"file_type": "stl"}),
        ("text.stl", 1.0, {"file_type": "stl_ascii"}),
        ("a.ply", 1.0, {}),
        ("a.obj", 1.0, {}),
        ("a.3mf", 1.0, {}),
        ("a.glb", 1e-3, {}),
    ],
)
def test_formats(gear, tmp_path, name, scale, words):
    mesh = read_mesh(saved(gear, tmp_path / name, scale, **words))
    assert volume(mesh) == pytest.approx(volume(gear), rel=1e-5)
    # equal corners are joined again
    assert len(mesh[0]) == len(gear[0])
    check_solid(*mesh)


def with_unit(path, unit):
    plain = path.with_name("plain.3mf")
    path.rename(plain)
    with zipfile.ZipFile(plain) as old, zipfile.ZipFile(path, "w") as new:
        for name in old.namelist():
            data = old.read(name)
            if name.endswith(".model"):
                data = re.sub(rb' unit="[^"]*"', b"", data, count=1)
                data = data.replace(b"<model ", b'<model unit="' + unit.encode() + b'" ', 1)
            new.writestr(name, data)
    return path


@pytest.mark.parametrize("unit", PER_UNIT)
def test_declared_units_of_3mf(gear, tmp_path, unit):
    path = with_unit(saved(gear, tmp_path / "a.3mf", 1 / PER_UNIT[unit]), unit)
    assert volume(read_mesh(path)) == pytest.approx(volume(gear), rel=1e-4)


def test_an_unknown_unit_is_refused_unless_it_is_named(gear, tmp_path):
    path = with_unit(saved(gear, tmp_path / "a.3mf"), "furlong")
    with pytest.raises(InputError, match="unknown unit 'furlong'"):
        read_mesh(path)
    assert volume(read_mesh(path, "mm")) == pytest.approx(volume(gear), rel=1e-4)


@pytest.mark.parametrize(("unit", "scale"), [("inch", 25.4), ("m", 1000.0), ("um", 0.001), ("cm", 10.0)])
@pytest.mark.parametrize("suffix", ["stl", "glb"])
def test_named_units(gear, tmp_path, unit, scale, suffix):
    """What the user says is one unit of the file holds, whatever the file declares."""
    path = saved(gear, tmp_path / f"a.{suffix}", 1 / scale)
    assert volume(read_mesh(path, unit)) == pytest.approx(volume(gear), rel=1e-4)


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("empty.stl", b"", "the file is empty"),
        ("empty.3mf", b"", "the file is empty"),
        ("head.stl", bytes(84), "no triangles"),
        ("short.stl", bytes(80) + b"\x09\0\0\0" + bytes(100), "not a readable mesh|no triangles"),
        ("junk.stl", bytes(range(256)) * 40, "not a readable mesh|no triangles"),
        ("words.stl", b"solid nothing\nendsolid\n", "no triangles|not a readable mesh"),
        ("junk.glb", b"glTF" + bytes(300), "not a readable mesh"),
        ("junk.3mf", b"PK\x03\x04junk", "not a readable mesh"),
        ("junk.ply", b"ply\nformat junk\n", "not a readable mesh"),
        ("part.step", b"ISO-10303-21;", r"\.step names no format of meshes"),
    ],
)
def test_files_that_hold_no_mesh(tmp_path, name, content, words):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(InputError, match=words) as caught:
        read_mesh(path)
    assert str(caught.value).startswith(f"{path}: error: ")


def test_missing_file_and_point_cloud(gear, tmp_path):
    with pytest.raises(InputError, match="there is no such file"):
        read_mesh(tmp_path / "nowhere.stl")
    trimesh.PointCloud(gear[0]).export(tmp_path / "cloud.ply")
    with pytest.raises(InputError, match="no triangles"):
        read_mesh(tmp_path / "cloud.ply")


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_joining_is_what_unique_rows_are(dtype):
    rng = np.random.default_rng(7)
    points = rng.integers(-3, 4, (4000, 3)).astype(dtype) / 7
    points[::5] *= -1
    points[points == 0] = rng.choice(np.array([0.0, -0.0], dtype=dtype), np.count_nonzero(points == 0))
    left, index = joined(points)
    np.testing.assert_array_equal(left[index], points)
    assert len(left) == len(np.unique(points, axis=0))


@pytest.mark.parametrize("name", ["a.stl.gz", "a.stl", "a.obj"])
def test_a_compressed_file_is_named(gear, tmp_path, name):
    path = tmp_path / name
    path.write_bytes(gzip.compress(saved(gear, tmp_path / "plain.stl").read_bytes()))
    with pytest.raises(InputError, match=r"compressed by gzip .*unpack it first"):
        read_mesh(path)


def test_a_folder_is_no_mesh(tmp_path):
    with pytest.raises(InputError, match="is a folder"):
        read_mesh(tmp_path)
