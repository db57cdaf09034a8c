"""`hobtwin new`: a job and a program to begin with."""

import argparse
from pathlib import Path

from twin.errors import ExitCode, InputError, Place
from twin.starter.gear import GearOrder, draft_gear
from twin.starter.plan import Draft
from twin.starter.polygon import PolygonOrder, draft_polygon


def new_command(options: argparse.Namespace) -> ExitCode:
    """Write job.toml and program.nc into a new or empty folder. Raises InputError."""
    folder: Path = options.out
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(
            "not an empty folder: nothing was written",
            place=Place(file=str(folder)),
            remedy="valid: --out DIR that does not exist or is empty",
        )
    draft = _gear(options) if options.part == "gear" else _polygon(options)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "program.nc").write_text(draft.program, encoding="utf-8")
        (folder / "job.toml").write_text(draft.job, encoding="utf-8")
    except OSError as error:
        reason = error.strerror or "cannot be written"
        raise InputError(reason, place=Place(file=str(folder))) from error
    print(draft.summary)
    print(f"written: {folder / 'job.toml'}, {folder / 'program.nc'}")
    print(f"next: hobtwin run {folder}")
    return ExitCode.FINE


def _gear(options: argparse.Namespace) -> Draft:
    return draft_gear(
        GearOrder(
            module=options.module,
            teeth=options.teeth,
            helix_deg=options.helix,
            width=options.width,
            profile_shift=options.profile_shift,
            pressure_angle_deg=options.pressure_angle,
            bore=options.bore,
            accuracy_class=options.accuracy_class,
            hob_diameter=options.hob_diameter,
            gashes=options.gashes,
            starts=options.starts,
            cutting_speed=options.cutting_speed,
            feed=options.feed,
        )
    )


def _polygon(options: argparse.Namespace) -> Draft:
    return draft_polygon(
        PolygonOrder(
            sides=options.sides,
            across_flats=options.across_flats,
            length=options.length,
            inserts=options.inserts,
            tip_radius=options.tip_radius,
            speed=options.speed,
            feed=options.feed,
        )
    )


def add_new(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> argparse.ArgumentParser:
    """The arguments of `new`."""
    new = commands.add_parser("new", help="write a job and a program to begin with")
    parts = new.add_subparsers(title="parts", dest="part", required=True, metavar="PART")
    gear = parts.add_parser("gear", help="a spur or helical gear, hobbed in one pass")
    gear.add_argument("--module", type=float, required=True, metavar="MM", help="normal module")
    gear.add_argument("--teeth", type=int, required=True)
    gear.add_argument("--helix", type=float, default=0.0, metavar="DEG", help="+ right-hand")
    gear.add_argument("--width", type=float, metavar="MM", help="face width (default: ten modules)")
    gear.add_argument("--profile-shift", type=float, default=0.0, metavar="X")
    gear.add_argument("--pressure-angle", type=float, default=20.0, metavar="DEG")
    gear.add_argument("--bore", type=float, metavar="MM", help="0 = solid (default: chosen)")
    gear.add_argument("--class", type=int, default=8, dest="accuracy_class", metavar="A", help="ISO 1328-1")
    gear.add_argument("--hob-diameter", type=float, metavar="MM", help="(default: by module)")
    gear.add_argument("--gashes", type=int)
    gear.add_argument("--starts", type=int, default=1)
    gear.add_argument("--cutting-speed", type=float, default=60.0, metavar="M/MIN")
    gear.add_argument("--feed", type=float, metavar="MM", help="per turn of the work (default: by class)")
    polygon = parts.add_parser("polygon", help="flats turned with a head of inserts")
    polygon.add_argument("--sides", type=int, required=True)
    polygon.add_argument("--across-flats", type=float, required=True, metavar="MM")
    polygon.add_argument("--length", type=float, default=10.0, metavar="MM")
    polygon.add_argument("--inserts", type=int, help="(default: half the sides)")
    polygon.add_argument("--tip-radius", type=float, default=40.0, metavar="MM")
    polygon.add_argument("--speed", type=int, default=300, metavar="RPM", help="of the work")
    polygon.add_argument("--feed", type=float, default=0.5, metavar="MM", help="per turn of the work")
    for part in (gear, polygon):
        part.add_argument("--out", type=Path, required=True, metavar="DIR", help="new or empty folder")
    return new
