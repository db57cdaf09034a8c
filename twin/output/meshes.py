"""The part as STL (binary, mm), GLB (metres, as glTF demands) and 3MF (mm)."""

import json
import zipfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from twin.output.numerals import rows_of_text

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
"""of a binary STL"""
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER, FLOAT, UNSIGNED_INT, TRIANGLES = 34962, 34963, 5126, 5125, 4
"""glTF 2.0: targets of buffer views, types of components, mode of a primitive"""
NANOMETRES = 1_000_000
"""per mm: what a 3MF tells apart"""
ROWS = 1 << 15
"""that become text at once"""

_TYPES = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="model" '
    'ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>'
)
_RELATIONS = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    '<Relationship Target="/3D/3dmodel.model" Id="rel0" '
    'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
)
_EPOCH = (1980, 1, 1, 0, 0, 0)


def write_stl(path: Path, vertices: Floats, faces: Ints) -> None:
    """Binary STL; vertices (n, 3) in mm."""
    points = vertices.astype(np.float32)
    a, b, c = (points[corner] for corner in faces.T)
    normal = np.cross(b - a, c - a)
    length = np.sqrt(np.einsum("nx,nx->n", normal, normal))
    table = np.zeros(len(faces), dtype=TRIANGLE)
    table["normal"] = normal / np.where(length > 0, length, 1.0)[:, None]
    for corner, place in enumerate((a, b, c)):
        table["corners"][:, corner] = place
    with path.open("wb") as file:
        file.write(b"hobtwin".ljust(80, b"\0"))
        file.write(np.uint32(len(faces)).tobytes())
        file.write(table.data)


def write_glb(path: Path, vertices: Floats, faces: Ints) -> None:
    """GLB, the binary container of glTF 2.0, in metres; vertices (n, 3) in mm."""
    points = (vertices / 1000.0).astype("<f4")
    corners = faces.astype("<u4")
    meta = {
        "asset": {"version": "2.0", "generator": "hobtwin"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": TRIANGLES}]},
        ],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": FLOAT,
                "count": len(points),
                "type": "VEC3",
                "min": points.min(axis=0).tolist(),
                "max": points.max(axis=0).tolist(),
            },
            {"bufferView": 1, "componentType": UNSIGNED_INT, "count": corners.size, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": points.nbytes, "target": ARRAY_BUFFER},
            {
                "buffer": 0,
                "byteOffset": points.nbytes,
                "byteLength": corners.nbytes,
                "target": ELEMENT_ARRAY_BUFFER,
            },
        ],
        "buffers": [{"byteLength": points.nbytes + corners.nbytes}],
    }
    text = json.dumps(meta, separators=(",", ":")).encode()
    text = text.ljust(-(-len(text) // 4) * 4, b" ")
    content = points.nbytes + corners.nbytes  # of four-byte numbers: aligned as it is
    with path.open("wb") as file:
        file.write(b"glTF" + np.array([2, 28 + len(text) + content, len(text)], dtype="<u4").tobytes())
        file.write(b"JSON" + text)
        file.write(np.uint32(content).tobytes() + b"BIN\0")
        file.write(points.data)
        file.write(corners.data)


def write_3mf(path: Path, vertices: Floats, faces: Ints) -> None:
    """3MF core specification 1.3: one object in millimetres, to the nanometre; vertices (n, 3) in mm."""
    with zipfile.ZipFile(path, "w") as package:
        for name, text in (
            ("[Content_Types].xml", _TYPES.encode()),
            ("_rels/.rels", _RELATIONS.encode()),
            ("3D/3dmodel.model", b"".join(_model(vertices, faces))),
        ):
            entry = zipfile.ZipInfo(name, _EPOCH)
            package.writestr(entry, text, zipfile.ZIP_DEFLATED, compresslevel=1)


def _model(vertices: Floats, faces: Ints) -> Iterator[bytes]:
    """The text of a model, piece by piece."""
    yield (
        b'<?xml version="1.0" encoding="UTF-8"?>\n'
        b'<model unit="millimeter" xml:lang="en-US" '
        b'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>'
        b'<object id="1" type="model"><mesh><vertices>'
    )
    for low in range(0, len(vertices), ROWS):
        places = np.rint(vertices[low : low + ROWS] * NANOMETRES).astype(np.int64)
        yield rows_of_text(places, (b'<vertex x="', b'" y="', b'" z="', b'"/>'), decimals=6)
    yield b"</vertices><triangles>"
    for low in range(0, len(faces), ROWS):
        yield rows_of_text(faces[low : low + ROWS], (b'<triangle v1="', b'" v2="', b'" v3="', b'"/>'))
    yield b'</triangles></mesh></object></resources><build><item objectid="1"/></build></model>'
