"""`hobtwin inspect`"""

import argparse
import json
import warnings
from pathlib import Path

import numpy as np
import trimesh

from twin.errors import ExitCode, InputError, Place
from twin.inspection.inspection import inspect
from twin.inspection.nominal import GearNominal, Nominal, PolygonNominal
from twin.inspection.result import Verdict
from twin.inspection.sheet import to_json
from twin.job import read_job
from twin.summary import part_lines

FORMATS = "STL, 3MF, GLB, PLY, OBJ"


def inspect_command(options: argparse.Namespace) -> ExitCode:
    """Measure a mesh in millimetres. Raises HobtwinError."""
    nominal = _nominal(options)
    vertices, faces = read_mesh(options.mesh)
    found = inspect(vertices, faces, nominal)
    if options.format == "json":
        print(json.dumps(to_json(found), indent=2, ensure_ascii=False, allow_nan=False))
    else:
        print("\n".join(part_lines(found)))
    unfit = found.verdict is Verdict.OUT or found.kind is None
    return ExitCode.FINDING if unfit else ExitCode.FINE


def read_mesh(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) [mm] and faces (m, 3), equal vertices joined. GLB is in metres by definition.

    Raises InputError for what cannot be read as a mesh.
    """
    place = Place(file=str(path))
    if not path.is_file():
        raise InputError("there is no such file", place=place)
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            mesh = trimesh.load_mesh(path, process=False)
    except Exception as cause:  # readers raise whatever they please on damaged files
        raise InputError(
            "not a readable mesh",
            place=place,
            remedy=f"valid: {FORMATS}",
        ) from cause
    if not isinstance(mesh, trimesh.Trimesh) or not len(mesh.faces):
        raise InputError("the file holds no triangles", place=place, remedy=f"valid: {FORMATS}")
    mesh.merge_vertices(merge_tex=True, merge_norm=True)
    scale = 1000.0 if path.suffix.lower() in (".glb", ".gltf") else 1.0
    return np.asarray(mesh.vertices, dtype=float) * scale, np.asarray(mesh.faces, dtype=np.int64)


def _nominal(options: argparse.Namespace) -> Nominal | None:
    gear = options.teeth is not None or options.module is not None
    polygon = options.sides is not None or options.across_flats is not None
    if gear + polygon + bool(options.job) > 1:
        raise InputError("a nominal is named twice", remedy="one of --job, --teeth …, --sides …")
    if options.accuracy_class is not None and not gear:
        raise InputError("--class judges a nominal gear", remedy="add --teeth and --module")
    if options.job:
        return read_job(options.job).nominal
    if gear:
        if options.teeth is None or options.module is None:
            raise InputError("a nominal gear needs --teeth and --module")
        return GearNominal(
            number_of_teeth=options.teeth,
            normal_module_mm=options.module,
            helix_angle_deg=options.helix,
            profile_shift=options.profile_shift,
            normal_pressure_angle_deg=options.pressure_angle,
            accuracy_class=options.accuracy_class,
        )
    if polygon:
        if options.sides is None or options.across_flats is None:
            raise InputError("a nominal polygon needs --sides and --across-flats")
        return PolygonNominal(number_of_sides=options.sides, across_flats_mm=options.across_flats)
    return None
