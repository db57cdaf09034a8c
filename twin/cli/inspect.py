"""`hobtwin inspect`"""

import argparse
import json
import math
import re
from pathlib import Path
from typing import Literal

from twin.errors import ExitCode, InputError, Place
from twin.inspection.axis import straightened
from twin.inspection.beside import Beside
from twin.inspection.columns import csv_lines
from twin.inspection.inspection import PRESSURE_DEG, inspect
from twin.inspection.mesh_files import read_mesh
from twin.inspection.nominal import TOLERANCE, GearNominal, Nominal, PolygonNominal
from twin.inspection.result import Inspection, Verdict
from twin.inspection.sheet import to_json
from twin.inspection.solid import Floats, Ints, MeshError, check_solid
from twin.inspection.text import text_lines

Mesh = tuple[Floats, Ints]
COMPARISON_OPTIONS = ("against_units", "tolerance_um", "report")
"""options that say more of --against"""
GEAR_OPTIONS = ("helix", "profile_shift", "accuracy_class", "tip_diameter", "pin_diameter", "face_width")
"""options that say more of a gear named by --teeth and --module"""


def inspect_command(options: argparse.Namespace, mesh: Beside[Mesh]) -> ExitCode:
    """Measure a mesh that is being read. Raises HobtwinError."""
    _check_comparison(options)
    nominal = _nominal(options)
    teeth = _teeth(options.teeth_to_measure)
    if options.against is not None:
        return _compare(options, mesh.result(), nominal, teeth)
    found = _inspected(options.mesh, mesh.result(), options, nominal, teeth)
    if options.csv is not None:
        _write_csv(options.csv, found)
    if options.format == "json":
        print(json.dumps(to_json(found), indent=2, ensure_ascii=False, allow_nan=False))
    else:
        print("\n".join(text_lines(found)))
    unfit = found.verdict is Verdict.OUT or found.kind is None
    return ExitCode.FINDING if unfit else ExitCode.FINE


def _inspected(
    path: Path,
    mesh: Mesh,
    options: argparse.Namespace,
    nominal: Nominal | None,
    teeth: tuple[int, ...] | Literal["all"] | None,
) -> Inspection:
    try:
        return inspect(
            *mesh,
            nominal,
            teeth=teeth,
            pressure_deg=PRESSURE_DEG if options.pressure_angle is None else options.pressure_angle,
            own_axis=options.find_axis,
        )
    except MeshError as fault:
        raise InputError(fault.text, place=Place(file=str(path)), remedy=fault.remedy) from fault


def _check_comparison(options: argparse.Namespace) -> None:
    """Options that belong to --against alone, and what they may be."""
    loose = [name for name in COMPARISON_OPTIONS if getattr(options, name) is not None]
    if loose and options.against is None:
        raise InputError(
            f"--{loose[0].replace('_', '-')} belongs to a comparison", remedy="add --against MESH"
        )
    tolerance = options.tolerance_um
    if tolerance is not None and not (math.isfinite(tolerance) and tolerance >= 0):
        raise InputError(f"--tolerance-um {tolerance:g}", remedy="valid: from 0, for example 5")
    if options.against is not None and options.csv is not None:
        raise InputError("--csv writes the traces of one part", remedy="leave out --against")


def _compare(
    options: argparse.Namespace,
    mesh: Mesh,
    nominal: Nominal | None,
    teeth: tuple[int, ...] | Literal["all"] | None,
) -> ExitCode:
    """One mesh against another. Exit code 1 only where --tolerance-um is exceeded."""
    from twin.comparison.compare import compare  # noqa: PLC0415 - a single mesh needs none of this
    from twin.comparison.words import text_lines as comparison_lines  # noqa: PLC0415
    from twin.comparison.words import to_json as comparison_json  # noqa: PLC0415

    other = read_mesh(options.against, options.against_units)
    parts = []
    for path, read in ((options.mesh, mesh), (options.against, other)):
        found = _inspected(path, read, options, nominal, teeth)
        solid = check_solid(*read)
        parts.append((solid if found.axis is None else straightened(solid, found.axis), found))
    comparison = compare(parts[0], parts[1])
    if options.report is not None:
        from twin.comparison.page import write_comparison  # noqa: PLC0415

        write_comparison(options.report, comparison, parts[0][0], _names(options.mesh, options.against))
    if options.format == "json":
        print(json.dumps(comparison_json(comparison), indent=2, ensure_ascii=False, allow_nan=False))
    else:
        print("\n".join(comparison_lines(comparison, tolerance_um=options.tolerance_um)))
        if options.report is not None:
            print(f"report: {options.report}")
    beyond = options.tolerance_um is not None and comparison.largest_um > options.tolerance_um
    return ExitCode.FINDING if beyond else ExitCode.FINE


def _names(a: Path, b: Path) -> tuple[str, str]:
    """Of two files; with their folders where the names alone are the same."""
    return (a.name, b.name) if a.name != b.name else (str(a), str(b))


def _write_csv(path: Path, found: Inspection) -> None:
    if found.gear is None:
        return
    try:
        path.write_text("\n".join(csv_lines(found.gear)) + "\n", encoding="utf-8")
    except OSError as cause:
        raise InputError(f"cannot be written: {cause.strerror}", place=Place(file=str(path))) from cause


def _teeth(text: str | None) -> tuple[int, ...] | Literal["all"] | None:
    """Return the teeth named by "1,6,11" or "all"; None where none are."""
    if text is None:
        return None
    if text == "all":
        return "all"
    if not re.fullmatch(r"\d+(,\d+)*", text):
        raise InputError(f"--teeth-to-measure {text}", remedy="valid: all, or numbers such as 1,6,11,16")
    return tuple(int(number) for number in text.split(","))


def _nominal(options: argparse.Namespace) -> Nominal | None:
    gear = options.teeth is not None or options.module is not None
    polygon = options.sides is not None or options.across_flats is not None
    if gear + polygon + bool(options.job) > 1:
        raise InputError("a nominal is named twice", remedy="one of --job, --teeth …, --sides …")
    loose = [name for name in GEAR_OPTIONS if getattr(options, name) is not None]
    if loose and not gear:
        name = "class" if loose[0] == "accuracy_class" else loose[0].replace("_", "-")
        raise InputError(f"--{name} belongs to a nominal gear", remedy="add --teeth and --module")
    if options.tolerance is not None and not polygon:
        raise InputError("--tolerance belongs to a nominal polygon", remedy="add --sides and --across-flats")
    if options.job:
        from twin.job import read_job  # noqa: PLC0415 - a bare mesh needs none of this

        return read_job(options.job).nominal
    if gear:
        return _gear(options)
    if polygon:
        if options.sides is None or options.across_flats is None:
            raise InputError("a nominal polygon needs --sides and --across-flats")
        return PolygonNominal(
            number_of_sides=options.sides,
            across_flats_mm=options.across_flats,
            tolerance=options.tolerance or TOLERANCE,
        )
    return None


def _gear(options: argparse.Namespace) -> GearNominal:
    if options.teeth is None or options.module is None:
        raise InputError("a nominal gear needs --teeth and --module")
    return GearNominal(
        number_of_teeth=options.teeth,
        normal_module_mm=options.module,
        helix_angle_deg=options.helix or 0.0,
        profile_shift=options.profile_shift or 0.0,
        normal_pressure_angle_deg=PRESSURE_DEG if options.pressure_angle is None else options.pressure_angle,
        accuracy_class=options.accuracy_class,
        tip_diameter_mm=options.tip_diameter,
        pin_diameter_mm=options.pin_diameter,
        face_width_mm=options.face_width,
    )
