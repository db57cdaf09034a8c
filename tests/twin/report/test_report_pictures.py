"""Still pictures: against brute force, and against silhouettes with a known area."""

import struct
import zlib

import numpy as np
import pytest

from twin.report.colours import palette
from twin.report.pictures import END, ISOMETRIC, Tint, place, render_part, steel
from twin.report.png import png_indexed, png_rgba
from twin.report.raster import visible

BOX = np.array([[x, y, z] for x in (-3, 3) for y in (-2, 2) for z in (-5, 0)], float)
BOX_FACES = np.array(
    [
        [0, 1, 3],
        [0, 3, 2],
        [4, 6, 7],
        [4, 7, 5],
        [0, 4, 5],
        [0, 5, 1],
        [2, 3, 7],
        [2, 7, 6],
        [0, 2, 6],
        [0, 6, 4],
        [1, 5, 7],
        [1, 7, 3],
    ]
)


def chunks(png):
    """Names and data of a PNG's chunks, each held against its checksum."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    at, found = 8, {}
    while at < len(png):
        (length,) = struct.unpack(">I", png[at : at + 4])
        name, data = png[at + 4 : at + 8], png[at + 8 : at + 8 + length]
        assert struct.unpack(">I", png[at + 8 + length : at + 12 + length])[0] == zlib.crc32(name + data)
        found[name] = data
        at += 12 + length
    return found


def decoded(png):
    """Rows of a PNG by the letter of RFC 2083, filters none, sub and up; bytes (height, width, channels)."""
    found = chunks(png)
    width, height, depth, kind, *_ = struct.unpack(">IIBBBBB", found[b"IHDR"])
    assert depth == 8
    channels = {3: 1, 6: 4}[kind]
    rows = np.frombuffer(zlib.decompress(found[b"IDAT"]), np.uint8).reshape(height, 1 + channels * width)
    image, above = [], np.zeros((width, channels), np.uint8)
    for row in rows:
        line = row[1:].reshape(width, channels)
        line = {0: line, 1: np.cumsum(line, axis=0, dtype=np.uint8), 2: line + above}[int(row[0])]
        image.append(line)
        above = line
    return np.array(image), found


def pixels(png):
    return decoded(png)[0].astype(float) / 255


def test_pixels_come_back_from_a_png():
    rng = np.random.default_rng(1)
    image = rng.integers(0, 256, (7, 13, 4), dtype=np.uint8)
    np.testing.assert_array_equal(decoded(png_rgba(image))[0], image)
    index = rng.integers(0, 256, (5, 9), dtype=np.uint8)
    colours = rng.integers(0, 256, (256, 4), dtype=np.uint8)
    back, found = decoded(png_indexed(index, colours))
    np.testing.assert_array_equal(back[..., 0], index)
    assert found[b"PLTE"] == colours[:, :3].tobytes()
    assert found[b"tRNS"] == colours[:, 3].tobytes()


@pytest.mark.parametrize("seed", range(30))
def test_the_nearest_triangle_is_seen_in_every_pixel(seed):
    """Against the definition, pixel by pixel: inside all three edges, largest depth."""
    width, height = 32, 24
    rng = np.random.default_rng(seed)
    corner = rng.uniform(-4, 36, (3, 3, 12))
    corner[1, :2, ::4] = 7.5  # some edges run along a row of pixel middles
    (ax, bx, cx), (ay, by, cy) = corner[:2]
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    corner = np.where(area < 0, corner, corner[:, [0, 2, 1]]).astype(np.float32)[:, :, np.abs(area) > 1]
    pixel, seen, _ = visible(corner, width, height)
    got = np.full(width * height, -1)
    got[pixel] = seen
    (ax, bx, cx), (ay, by, cy), depth = corner.astype(float)
    for k in range(width * height):
        x, y = k % width + 0.5, k // width + 0.5
        edges = np.stack(
            [
                (bx - ax) * (y - ay) - (by - ay) * (x - ax),
                (cx - bx) * (y - by) - (cy - by) * (x - bx),
                (ax - cx) * (y - cy) - (ay - cy) * (x - cx),
            ]
        )
        weight = edges[[1, 2, 0]] / edges.sum(axis=0)
        at = (weight * depth).sum(axis=0)
        sure, possible = (weight > 1e-4).all(axis=0), (weight > -1e-4).all(axis=0)
        if got[k] < 0:
            assert not sure.any()
        else:
            assert possible[got[k]]
            assert not sure.any() or at[got[k]] >= at[sure].max() - 1e-3


def test_the_end_of_a_box_fills_its_rectangle():
    (png,) = render_part(BOX, BOX_FACES, (300, 200), [(END, None)])
    image = pixels(png)
    assert image.shape == (200, 300, 4)
    # 6 mm on 4 mm fill 96 % of 300 × 200 pixels in both directions.
    assert image[..., 3].mean() == pytest.approx(0.96**2, abs=2e-3)
    assert set(np.unique(image[3:-3, 5:-5, 3][10:-10, 10:-10])) == {1.0}


def test_a_gear_covers_the_area_of_its_outline(sample):
    part = sample.gear_part(around=75, along=4)
    outline = part.vertices[: 75 * 20, :2] @ [1, 1j]
    area = (outline * np.roll(outline.conj(), 1)).imag.sum() / 2 - np.pi * 6.0**2
    (png,) = render_part(part.vertices, part.faces, (300, 300), [(END, None)])
    extent = np.ptp(part.vertices[:, :2], axis=0).max()
    assert pixels(png)[..., 3].sum() * (extent / (0.96 * 300)) ** 2 == pytest.approx(area, rel=2e-3)


@pytest.mark.parametrize("view", [END, ISOMETRIC])
def test_points_are_placed_where_they_are_drawn(view):
    (png,) = render_part(BOX, BOX_FACES, (300, 200), [(view, None)])
    covered = np.argwhere(pixels(png)[..., 3] > 0.5)[:, ::-1]
    at = place(BOX, (300, 200), view, BOX)
    assert at.min(axis=0) == pytest.approx(covered.min(axis=0), abs=1)
    assert at.max(axis=0) == pytest.approx(covered.max(axis=0) + 1, abs=1)


def test_a_flat_face_shows_no_trace_of_its_triangles():
    fan = np.array([[np.cos(a), np.sin(a), 0] for a in np.linspace(0, 2 * np.pi, 40, endpoint=False)])
    faces = np.array([[0, k, k + 1] for k in range(1, 39)])
    (png,) = render_part(fan, faces, (200, 200), [(END, None)])
    inside = pixels(png)[60:140, 60:140, 0]
    down, across = np.mgrid[:80, :80]
    plane = np.stack([down, across, np.ones_like(down)], -1).reshape(-1, 3)
    residual = inside.ravel() - plane @ np.linalg.lstsq(plane, inside.ravel(), rcond=None)[0]
    assert np.abs(residual).max() < 1.01 / 255


def test_a_sharp_edge_is_not_blurred():
    (png,) = render_part(BOX, BOX_FACES, (300, 300), [(ISOMETRIC, None)])
    image = pixels(png)
    top, left, right = (
        image[tuple(np.rint(place(BOX, (300, 300), ISOMETRIC, np.array([at]))[0])[::-1].astype(int))][0]
        for at in ((0.0, 0, 0), (0, -2.0, -2.5), (3.0, 0, -2.5))
    )
    assert top > right + 0.1
    assert abs(left - right) > 0.03


def test_light_comes_from_the_upper_left():
    normal = np.array([[-0.45, 0.45], [0.65, -0.65], [0.61, 0.61]])
    brightness = steel(normal / np.linalg.norm(normal, axis=0))
    assert brightness[0] > 2 * brightness[1]


def test_an_empty_mesh_gives_an_empty_picture():
    (png,) = render_part(np.zeros((0, 3)), np.zeros((0, 3), int), (40, 30), [(END, None)])
    assert pixels(png).shape == (30, 40, 4)
    assert not pixels(png)[..., 3].any()


def test_a_tint_paints_what_has_a_value_and_leaves_the_rest_of_steel():
    index = np.where(BOX[:, 2] == 0, 255, 0).astype(np.uint8)
    tint = Tint(index=index, palette=palette())
    plain, tinted = (
        pixels(png) for png in render_part(BOX, BOX_FACES, (300, 300), [(ISOMETRIC, None), (ISOMETRIC, tint)])
    )
    np.testing.assert_array_equal(plain[..., 3], tinted[..., 3])
    places = np.rint(
        place(BOX, (300, 300), ISOMETRIC, np.array([(0.0, 0, 0), (0, -2.0, -2.5), (3.0, 0, -2.5)]))
    )
    top, *sides = (tuple(at[::-1].astype(int)) for at in places)
    red, green, blue, _ = tinted[top]
    assert red > 2 * green
    assert red > 2 * blue
    for side in sides:
        np.testing.assert_array_equal(tinted[side], plain[side])
