"""Whatever the short ways leave, by trimesh: polygons, textures, nested objects, glTF in several files."""

import logging
import warnings
from pathlib import Path

import numpy as np

from twin.inspection.formats.raw import DamagedError, Raw


def read_other(path: Path) -> Raw:
    """Read a file of any format. Raises DamagedError."""
    import trimesh  # noqa: PLC0415 - half a second to load

    logging.getLogger("trimesh").addHandler(logging.NullHandler())  # what it stumbles over is ours to say
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            mesh = trimesh.load_mesh(path, process=False)
    except Exception as fault:  # readers raise whatever they please on damaged files
        raise DamagedError(f"{type(fault).__name__}") from fault
    suffix = path.suffix.lower()
    unit = "m" if suffix in (".glb", ".gltf") else "mm"
    if not isinstance(mesh, trimesh.Trimesh):
        return Raw(vertices=np.zeros((0, 3)), faces=None, unit=unit)
    for name, table in (("vertices", mesh.vertices), ("faces", mesh.faces)):
        if table.ndim != 2 or table.shape[1] != 3:
            raise DamagedError(f"its {name} have not three numbers each")
    if suffix == ".3mf":
        unit = str(mesh.units or "millimeter").removesuffix("s").lower()
    return Raw(
        vertices=np.asarray(mesh.vertices, dtype=np.float64),
        faces=np.asarray(mesh.faces, dtype=np.int64),
        unit=unit,
    )
