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
