"""The part as STL (binary, mm), GLB (metres, as glTF demands) and 3MF (mm)."""

import zipfile
from collections.abc import Iterable
from itertools import chain, repeat
from pathlib import Path

import msgspec
import numpy as np
import trimesh
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

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
    trimesh.Trimesh(vertices, faces, process=False).export(path)


def write_glb(path: Path, vertices: Floats, faces: Ints) -> None:
    """GLB in metres, as glTF demands; vertices (n, 3) in mm."""
    trimesh.Trimesh(vertices / 1000.0, faces, process=False).export(path)


def write_3mf(path: Path, vertices: Floats, faces: Ints) -> None:
    """3MF core specification 1.3: one object in millimetres, to the nanometre; vertices (n, 3) in mm."""
    points = _elements("vertex", ("x", "y", "z"), np.round(vertices, 6) + 0.0)
    triangles = _elements("triangle", ("v1", "v2", "v3"), faces)
    model = (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<model unit="millimeter" xml:lang="en-US" '
        'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>'
        f'<object id="1" type="model"><mesh><vertices>{points}</vertices>'
        f"<triangles>{triangles}</triangles></mesh></object>"
        '</resources><build><item objectid="1"/></build></model>'
    )
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as package:
        for name, text in (
            ("[Content_Types].xml", _TYPES),
            ("_rels/.rels", _RELATIONS),
            ("3D/3dmodel.model", model),
        ):
            entry = zipfile.ZipInfo(name, _EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            package.writestr(entry, text)


def _elements(name: str, attributes: tuple[str, ...], rows: Floats | Ints) -> str:
    """One empty XML element a row (n, k), a column an attribute."""
    texts = [msgspec.json.encode(column.tolist())[1:-1].decode().split(",") for column in rows.T]
    pieces: list[Iterable[str]] = []
    for attribute, column in zip(attributes, texts, strict=True):
        pieces += [repeat(f'<{name} {attribute}="' if not pieces else f'" {attribute}="'), column]
    return "".join(chain.from_iterable(zip(*pieces, repeat('"/>'), strict=False)))
