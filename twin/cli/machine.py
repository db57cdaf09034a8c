"""`hobtwin machine`: how the drives of a machine answer."""

import argparse
import sys
from pathlib import Path

from twin.errors import ExitCode, InputError, Place
from twin.job import read_job
from twin.machine import load_machine
from twin.machine.response import Response, both_responses, delivered_responses
from twin.presets import cutters_of
from twin.report.charts.drives import drives_file
from twin.setup import make_ready


def machine_command(options: argparse.Namespace) -> ExitCode:
    """Measure step and frequency response of every axis, of a model or of a job's machine as mounted.

    Raises InputError for a name that is neither, and for drives that are not stable.
    """
    pairs = _responses(options.machine)
    print("axis            k_ff  k_a   −3 dB  peak   overshoot  rise    unstable   off the transfer")
    print("                             [Hz]                    [ms]    from Kv    function")
    for found in (one for pair in pairs for one in pair):
        print(_row(found))
    out = options.out or Path("out") / f"{Path(options.machine).resolve().name}_drives.svg"
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_text(drives_file(pairs), encoding="utf-8")
    except OSError as error:
        raise InputError(
            f"cannot be written: {error.strerror}", place=Place(file=str(out)), remedy="another --out"
        ) from error
    print(f"picture: {out}", file=sys.stderr)
    return ExitCode.FINE


def _responses(name: str) -> list[tuple[Response, Response]]:
    path = Path(name)
    if path.is_file() or (path / "job.toml").is_file():
        job = read_job(path)
        return both_responses(make_ready(job, cutters_of(job)).driven)
    if (path / "machine.toml").is_file():
        return delivered_responses(load_machine(path.resolve().name, models=path.resolve().parent))
    return delivered_responses(load_machine(name))


def _row(found: Response) -> str:
    drive = found.drive.drive
    edge = "—" if found.bandwidth_hz is None else f"{found.bandwidth_hz:.0f}"
    return (
        f"{found.joint:<15} {drive.velocity_feedforward:<5g} {drive.acceleration_feedforward:<5g} {edge:<6} "
        f"{found.peak:<6.3f} {found.overshoot:<10.1%} {found.rise_s * 1e3:<7.1f} {found.gain_limit:<10.0f} "
        f"{found.off:.0e}"
    )
