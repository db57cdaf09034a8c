"""GLB, binary glTF 2.0: plain triangles of all nodes of the scene, in metres by definition."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from twin.inspection.formats.raw import DamagedError, Raw
from twin.inspection.solid import Floats, Ints

INDEX = {5121: np.dtype("<u1"), 5123: np.dtype("<u2"), 5125: np.dtype("<u4")}
"""componentType of indices -> their type"""
FLOAT = 5126
TRIANGLES = 4
DEEPEST = 100
"""nodes do not stand in each other deeper than this"""


def read_glb(path: Path) -> Raw | None:
    """Read a GLB file. Raises DamagedError."""
    data = path.read_bytes()
    if data[:4] != b"glTF" or len(data) < 20:
        raise DamagedError("it does not begin as a GLB file does")
    version, length = (int.from_bytes(data[i : i + 4], "little") for i in (4, 8))
    if version != 2:
        return None
    if length > len(data):
        raise DamagedError(f"it announces {length} bytes and holds {len(data)}")
    size = int.from_bytes(data[12:16], "little")
    binary = memoryview(data)[20 + size + 8 : length]
    try:
        tree = json.loads(data[20 : 20 + size])
        return _scene(tree, binary)
    except (KeyError, IndexError, TypeError, ValueError, AttributeError) as fault:
        raise DamagedError(f"its parts do not fit together ({fault})") from fault


def _scene(tree: dict[str, Any], binary: memoryview) -> Raw | None:
    if tree.get("extensionsRequired") or any("uri" in buffer for buffer in tree.get("buffers", [])):
        return None
    points: list[Floats] = []
    faces: list[Ints] = []
    nodes, scenes = tree.get("nodes", []), tree.get("scenes", [])
    roots = scenes[tree.get("scene", 0)].get("nodes", []) if scenes else list(range(len(nodes)))
    waiting = [(root, np.eye(4), 0) for root in roots]
    count = 0
    while waiting:
        number, above, depth = waiting.pop()
        if depth > DEEPEST:
            raise DamagedError("a node stands within itself")
        node = nodes[number]
        place = above @ _transform(node)
        waiting += [(child, place, depth + 1) for child in node.get("children", [])]
        for primitive in tree["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
            mesh = _primitive(tree, binary, primitive)
            if mesh is None:
                return None
            corners, triangles = mesh
            points.append(
                corners if np.array_equal(place, np.eye(4)) else corners @ place[:3, :3].T + place[:3, 3]
            )
            faces.append((triangles if np.linalg.det(place[:3, :3]) > 0 else triangles[:, ::-1]) + count)
            count += len(corners)
    if not points:
        return Raw(vertices=np.zeros((0, 3)), faces=None, unit="m")
    return Raw(vertices=np.concatenate(points), faces=np.concatenate(faces), unit="m")


def _primitive(
    tree: dict[str, Any], binary: memoryview, primitive: dict[str, Any]
) -> tuple[Floats, Ints] | None:
    """Return corners (n, 3) and triangles (m, 3); None: no plain triangles."""
    if primitive.get("mode", TRIANGLES) != TRIANGLES or primitive.get("extensions"):
        return None
    at = tree["accessors"][primitive["attributes"]["POSITION"]]
    if at["componentType"] != FLOAT or at["type"] != "VEC3" or "sparse" in at:
        return None
    points = _values(tree, binary, at, np.dtype("<f4"), 3)
    if "indices" not in primitive:
        return points, np.arange(len(points)).reshape(-1, 3)
    by = tree["accessors"][primitive["indices"]]
    if by["componentType"] not in INDEX or "sparse" in by:
        return None
    number = _values(tree, binary, by, INDEX[by["componentType"]], 1).astype(np.int64)
    if number.max(initial=-1) >= len(points):
        raise DamagedError(f"a face names vertex {number.max()} of {len(points)}")
    return points, number.reshape(-1, 3)


def _values(
    tree: dict[str, Any], binary: memoryview, at: dict[str, Any], kind: np.dtype, columns: int
) -> np.ndarray:
    """Return the values of an accessor (count, columns)."""
    view, count = tree["bufferViews"][at["bufferView"]], at["count"]
    begin = view.get("byteOffset", 0) + at.get("byteOffset", 0)
    width = columns * kind.itemsize
    stride = view.get("byteStride", width)
    if count <= 0 or begin + (count - 1) * stride + width > len(binary):
        raise DamagedError(f"it announces {count} values and ends within them")
    return np.ndarray((count, columns), kind, binary, begin, (stride, kind.itemsize))


def _transform(node: dict[str, Any]) -> Floats:
    """Return the matrix (4, 4) of a node, by columns or as translation, rotation, scale."""
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    matrix = np.eye(4)
    x, y, z, w = node.get("rotation", (0.0, 0.0, 0.0, 1.0))
    norm = math.hypot(x, y, z, w)
    if norm == 0:
        raise DamagedError("a node is turned by nothing")
    x, y, z, w = x / norm, y / norm, z / norm, w / norm
    turn = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, :3] = np.array(turn) * np.array(node.get("scale", (1.0, 1.0, 1.0)))
    matrix[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
    return matrix
