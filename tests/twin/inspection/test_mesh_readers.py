"""The short ways against trimesh, an independent reader, and every file that breaks off or lies."""

import io
import json
import struct
import zipfile

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from twin.cli.main import main
from twin.errors import InputError
from twin.inspection.formats.digits import whole_numbers
from twin.inspection.formats.others import read_other
from twin.inspection.mesh_files import read_mesh, short_way
from twin.inspection.solid import MeshError, check_solid
from twin.output.meshes import write_3mf, write_glb, write_stl

PLY = b"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
FACES = b"element face %d\nproperty list uchar int vertex_indices\nend_header\n"
CORNERS = b"0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
TETRAHEDRON = b"3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"


@pytest.fixture(scope="module")
def gear(parts):
    return parts.gear_mesh(teeth=9, module=2.0, helix_deg=12.0, width=5.0, z_step=2.5, roll_step=0.5)


def triangles(raw):
    faces = np.arange(len(raw.vertices)).reshape(-1, 3) if raw.faces is None else raw.faces
    return np.asarray(raw.vertices, dtype=np.float64)[faces]


def same(path, exact=True):
    """The short way reads the file, and as trimesh does, triangle by triangle."""
    short, other = short_way(path), read_other(path)
    assert short is not None
    np.testing.assert_allclose(triangles(short), triangles(other), rtol=0, atol=0 if exact else 1e-6)
    return short


@pytest.mark.parametrize("name", ["a.stl", "a.ply", "a.obj", "a.glb", "a.3mf"])
def test_files_of_trimesh(gear, tmp_path, name):
    trimesh.Trimesh(*gear, process=False).export(tmp_path / name)
    same(tmp_path / name)


@pytest.mark.parametrize(
    ("name", "write"), [("a.stl", write_stl), ("a.3mf", write_3mf), ("a.glb", write_glb)]
)
def test_files_of_ours(gear, tmp_path, name, write):
    write(tmp_path / name, *gear)
    same(tmp_path / name)


@pytest.mark.parametrize(
    ("name", "words"), [("a.stl", {"file_type": "stl_ascii"}), ("a.ply", {"encoding": "ascii"})]
)
def test_files_in_words(gear, tmp_path, name, words):
    trimesh.Trimesh(*gear, process=False).export(tmp_path / name, **words)
    same(tmp_path / name, exact=False)  # trimesh rounds what is written as float to single precision


def test_ply_in_words_with_more_said_of_faces(tmp_path):
    path = tmp_path / "a.ply"
    header = (FACES % 4).replace(b"end_header", b"property ushort stl\nend_header")
    path.write_bytes(PLY + header + CORNERS + TETRAHEDRON.replace(b"\n", b" 7\n"))
    raw = same(path)
    assert raw.faces.tolist() == [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]


@given(
    st.lists(st.tuples(st.integers(0, 10**9 - 1), st.integers(0, 2), st.sampled_from('",x \n')), min_size=1)
)
def test_whole_numbers_are_those_of_python(written):
    text, begin, end = "?", [], []
    for value, zeros, after in written:
        digits = ("0" * zeros + str(value))[-9:]
        begin.append(len(text))
        end.append(len(text) + len(digits))
        text += digits + after
    found = whole_numbers(
        np.frombuffer(text.encode(), dtype=np.uint8), np.array(begin), np.array(end, dtype=np.int64)
    )
    assert found.tolist() == [int(text[a:b]) for a, b in zip(begin, end, strict=True)]


@pytest.mark.parametrize("text", ["", "-1", "1.5", "1e3", "x", " 12", "1234567890"])
def test_what_is_no_whole_number(text):
    found = whole_numbers(
        np.frombuffer(f"?{text}?".encode(), dtype=np.uint8), np.array([1]), np.array([1 + len(text)])
    )
    assert found is None


def test_a_nan_that_signals_is_named(tmp_path):
    signalling = np.array([0x7FA00000] * 9, dtype="<u4")
    facet = bytes(12) + signalling.tobytes() + bytes(2)
    path = tmp_path / "a.stl"
    path.write_bytes(bytes(80) + struct.pack("<I", 1) + facet)
    vertices, faces = read_mesh(path)
    with pytest.raises(MeshError, match="not finite"):
        check_solid(vertices, faces)


@pytest.mark.parametrize("seed", range(60))
def test_damaged_files_end_in_a_result_or_a_message(gear, tmp_path_factory, capfd, seed):
    """Broken off, bytes changed, lost or added, in every format: no traceback, nothing of a library's."""
    rng = np.random.default_rng(seed)
    folder = tmp_path_factory.mktemp("damaged")
    suffix = ("stl", "glb", "3mf", "ply", "obj")[seed % 5]
    path = folder / f"a.{suffix}"
    trimesh.Trimesh(*gear, process=False).export(path)
    data = bytearray(path.read_bytes())
    at = int(rng.integers(len(data)))
    match seed // 5 % 4:
        case 0:
            del data[at:]
        case 1:
            data[at : at + 8] = rng.bytes(8)
        case 2:
            del data[at : at + int(rng.integers(1, 60))]
        case 3:
            data[at % 300 : at % 300] = rng.bytes(3)
    path.write_bytes(data)
    code = main(["inspect", str(path)])
    said = capfd.readouterr()
    assert code in (0, 1, 2)
    assert "Traceback" not in said.err
    assert said.err.count("\n") == (code == 2)


def test_words_in_capitals_and_exponents(tmp_path):
    text = (
        "SOLID A\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 1E0 2e-1 +3\nVERTEX 4 5 6.5\nVERTEX 7 -8 9\n"
        "ENDLOOP\nENDFACET\nENDSOLID A\n"
    )
    path = tmp_path / "a.stl"
    path.write_text(text, encoding="utf-8")
    raw = short_way(path)
    assert raw.vertices.tolist() == [[1, 0.2, 3], [4, 5, 6.5], [7, -8, 9]]


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("more", [False, True])
def test_binary_ply_of_any_order_and_more_properties(gear, tmp_path, order, more):
    vertices, faces = gear
    kinds = [("nx", "f4")] * more + [("x", "f8"), ("y", "f8"), ("z", "f8")] + [("red", "u1")] * more
    beside = [("flags", "u1"), ("area", "f8")] * more
    table = np.zeros(len(vertices), dtype=[(n, order + k) for n, k in kinds])
    for axis, column in zip("xyz", vertices.T, strict=True):
        table[axis] = column
    rows = np.zeros(
        len(faces), dtype=[("n", "u1"), ("v", order + "u4", 3), *((n, order + k) for n, k in beside)]
    )
    rows["n"], rows["v"] = 3, faces
    words = {"f4": "float", "f8": "double", "u1": "uchar"}
    header = [
        "ply",
        f"format binary_{'little' if order == '<' else 'big'}_endian 1.0",
        "comment element vertex 3",
        f"element vertex {len(vertices)}",
        *(f"property {words[k]} {n}" for n, k in kinds),
        f"element face {len(faces)}",
        "property list uchar uint vertex_indices",
        *(f"property {words[k]} {n}" for n, k in beside),
        "end_header\n",
    ]
    path = tmp_path / "a.ply"
    path.write_bytes("\n".join(header).encode() + table.tobytes() + rows.tobytes())
    raw = short_way(path)
    np.testing.assert_array_equal(raw.vertices, vertices)
    np.testing.assert_array_equal(raw.faces, faces)
    path.write_bytes(path.read_bytes()[:-5])
    with pytest.raises(InputError, match=f"announces {len(faces)} faces and ends within them"):
        read_mesh(path)


@pytest.mark.parametrize(
    "text",
    [
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n",
        "# a\r\no part\r\nv 0 0 0 1 1 1\r\nv 1 0 0 1 1 1\r\nv 0 1 0 1 1 1\r\nv 0 0 1 1 1 1\r\n"
        "f 1 3 2\r\nf 1 2 4\r\nf 2 3 4\r\nf 1 4 3\r\n",
        "v 0 0 0\nv 1 0 0\nvn 0 0 1\nv 0 1 0\nv 0 0 1\nvt 0 0\nf 1/1/1 3/1/1 2/1/1\ng x\nf 1//1 2//1 4//1\n"
        "f 2/1 3/1 4/1\nf 1 4 3\n",
    ],
)
def test_obj_by_hand(tmp_path, text):
    path = tmp_path / "a.obj"
    path.write_text(text, encoding="utf-8", newline="")
    raw = short_way(path)
    assert raw.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    assert raw.faces.tolist() == [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]


def test_polygons_and_counting_back_are_left_to_trimesh(tmp_path):
    cube = trimesh.creation.box()
    lines = [f"v {x} {y} {z}" for x, y, z in cube.vertices]
    quads = ["f 1 2 4 3", "f 5 7 8 6", "f 1 5 6 2", "f 3 4 8 7", "f 1 3 7 5", "f 2 6 8 4"]
    path = tmp_path / "a.obj"
    for faces in (quads, [" ".join(f"{int(w) - 9}" if w != "f" else w for w in q.split()) for q in quads]):
        path.write_text("\n".join(lines + faces), encoding="utf-8")
        assert short_way(path) is None
        vertices, found = read_mesh(path)
        assert (len(vertices), len(found)) == (8, 12)


def test_nodes_of_glb_stand_where_their_matrices_say(gear, tmp_path):
    scene = trimesh.Scene()
    turn = trimesh.transformations.rotation_matrix(0.7, [1, 2, 3], [4, 5, 6])
    mirror = np.diag([-1.0, 1.0, 1.0, 1.0])
    scene.add_geometry(trimesh.Trimesh(*gear, process=False), transform=turn, node_name="a", geom_name="g")
    scene.graph.update(frame_to="b", frame_from="a", matrix=mirror @ turn, geometry="g")
    scene.export(tmp_path / "a.glb")
    raw = same(tmp_path / "a.glb", exact=False)
    assert len(raw.faces) == 2 * len(gear[1])


def glb(tree, binary):
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    body = (
        struct.pack("<II", len(text), 0x4E4F534A)
        + text
        + struct.pack("<II", len(binary), 0x004E4942)
        + binary
    )
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def triangle(**changes):
    """A triangle turned by 90 degrees about x, twice as large, moved by 5 along z."""
    tree = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [
            {"mesh": 0, "translation": [0, 0, 5], "rotation": [0.5**0.5, 0, 0, 0.5**0.5], "scale": [2, 2, 2]}
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 6},
        ],
        "buffers": [{"byteLength": 44}],
    } | changes
    return glb(tree, np.eye(3, dtype="<f4").tobytes() + np.array([0, 1, 2, 0], dtype="<u2").tobytes())


def test_translation_rotation_and_scale_of_glb(tmp_path):
    path = tmp_path / "a.glb"
    path.write_bytes(triangle())
    raw = short_way(path)
    assert raw.unit == "m"
    np.testing.assert_allclose(raw.vertices, [[2, 0, 5], [0, 0, 7], [0, -2, 5]], atol=1e-12)
    assert raw.faces.tolist() == [[0, 1, 2]]


@pytest.mark.parametrize("item", ["", ' transform="0 1 0 -1 0 0 0 0 1 5 6 7"'])
def test_the_place_of_an_item_of_3mf(gear, tmp_path, item):
    path = tmp_path / "a.3mf"
    write_3mf(path, *gear)
    repacked(path, b'<item objectid="1"/>', f'<item objectid="1"{item}/>'.encode())
    same(path, exact=False)


def repacked(path, old, new):
    with zipfile.ZipFile(io.BytesIO(path.read_bytes())) as package, zipfile.ZipFile(path, "w") as changed:
        for name in package.namelist():
            data = package.read(name)
            if name.endswith(".model"):
                assert old in data
                data = data.replace(old, new, 1)
            changed.writestr(name, data)


def test_unusual_3mf_is_left_to_trimesh(gear, tmp_path):
    path = tmp_path / "a.3mf"
    write_3mf(path, *gear)
    repacked(path, b"<vertices>", b"<vertices><!-- x -->")
    assert short_way(path) is None
    assert len(read_mesh(path)[1]) == len(gear[1])


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("a.ply", PLY + FACES % 4 + CORNERS + TETRAHEDRON[:-4], "announces 4 vertices and 4 faces and ends"),
        ("a.ply", PLY + FACES % 4 + CORNERS + TETRAHEDRON.replace(b"3 0 3 2", b"3 0 3 4"), "vertices 0 to 4"),
        (
            "a.ply",
            PLY + FACES % 4 + CORNERS + TETRAHEDRON.replace(b"3 0 3 2", b"3 0 3 -2"),
            "vertices -2 to 3",
        ),
        (
            "a.ply",
            PLY + FACES % 4 + CORNERS + TETRAHEDRON.replace(b"3 0 3 2", b"3 0 3 .5"),
            "no whole number",
        ),
        ("a.ply", PLY + FACES % 4 + b"a" + CORNERS[1:] + TETRAHEDRON, "no number"),
        ("a.ply", b"ply\nformat ascii 1.0\n", "header has no end"),
        ("a.ply", b"ply\nelement vertex\nend_header\n", "header makes no sense"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "faces name vertices 0 to 3, there are 0 to 2"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "names vertex 0; the first is 1"),
        ("a.obj", b"v 0 0\nv 1 0\nv 0 1\nf 1 2 3\n", "3 vertices hold 6 numbers"),
        ("a.obj", b"v 0 0 x\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "no number"),
        ("a.obj", b"v 0 0 0\n", "no triangles"),
        ("a.stl", b"solid a\nfacet normal 0 0 1\n", "ends before its endsolid"),
        (
            "a.stl",
            bytes(80) + struct.pack("<I", 9) + bytes(100),
            "announces 9 triangles, 450 bytes, and holds 100",
        ),
        ("a.glb", triangle()[:-8], "announces"),
        ("a.glb", triangle(accessors=[]), "do not fit together"),
        ("a.glb", triangle(nodes=[{"children": [0]}]), "a node stands within itself"),
        ("a.glb", triangle(bufferViews=[{"buffer": 0, "byteOffset": 30}] * 2), "ends within them"),
        (
            "a.glb",
            triangle(accessors=[{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC2"}] * 2),
            "not three numbers each|not a readable mesh",
        ),
        ("a.3mf", b"PK\x03\x04" + bytes(50), "package cannot be opened"),
    ],
)
def test_files_that_break_off_or_lie(tmp_path, name, content, words):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(InputError, match=words) as caught:
        read_mesh(path)
    assert str(caught.value).startswith(f"{path}: error: ")


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (b'v1="0"', b'v1="99999"', "faces name vertices 0 to 99999"),
        (b'v1="0"', b'v1="-1"', "a corner names no vertex"),
        (b'x="', b'x="q', "no number"),
        (b'v2="', b'v2="0.5', "no number|no whole"),
    ],
)
def test_3mf_that_lies(gear, tmp_path, old, new, words):
    path = tmp_path / "a.3mf"
    write_3mf(path, *gear)
    repacked(path, old, new)
    with pytest.raises(InputError, match=words):
        read_mesh(path)
