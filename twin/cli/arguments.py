"""What each command takes: the tables of arguments, one function a command."""

import argparse
from pathlib import Path


def add_run(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> argparse.ArgumentParser:
    """`run`: the whole way."""
    run = commands.add_parser("run", help="run a job: program, machine, cut, inspection, report")
    run.add_argument("job", type=Path, metavar="JOB", help="a job folder or a job.toml")
    run.add_argument("--out", type=Path, metavar="DIR", help="result folder (default: out/<job name>)")
    run.add_argument("--ideal", action="store_true", help="axes follow their setpoints exactly")
    run.add_argument("--cell-mm", type=float, metavar="MM", help="cell of the cutting grid (default: chosen)")
    run.add_argument(
        "--tolerance-um",
        type=float,
        default=1.0,
        metavar="UM",
        help="of the mesh on flanks; roots have three times, other parts twice as much (default: 1)",
    )
    _add_events(run)
    run.add_argument("--chips", action="store_true", help="what each tooth takes away; writes chips.npz")
    run.add_argument("--strict", action="store_true", help="warnings are findings too")
    run.add_argument("--quiet", action="store_true", help="no progress")
    return run


def add_budget(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> argparse.ArgumentParser:
    """`budget`: what to mend first."""
    budget = commands.add_parser(
        "budget", help="what each fault and drive does to the gear, alone and together"
    )
    budget.add_argument("job", type=Path, metavar="JOB", help="a job folder or a job.toml")
    budget.add_argument(
        "--out", type=Path, metavar="DIR", help="result folder (default: out/<job name>_budget)"
    )
    budget.add_argument("--quiet", action="store_true", help="no progress")
    return budget


def add_compensate(
    commands: "argparse._SubParsersAction[argparse.ArgumentParser]",
) -> argparse.ArgumentParser:
    """`compensate`: probe how the part is clamped, and work around it."""
    compensate = commands.add_parser(
        "compensate", help="probe a badly clamped gear, compensate its program, compare both gears"
    )
    compensate.add_argument("job", type=Path, metavar="JOB", help="a job folder or a job.toml with [probe]")
    compensate.add_argument(
        "--out", type=Path, metavar="DIR", help="result folder (default: out/<job name>_compensated)"
    )
    compensate.add_argument("--ideal", action="store_true", help="axes follow their setpoints exactly")
    compensate.add_argument(
        "--cell-mm", type=float, metavar="MM", help="cell of the cutting grid (default: chosen)"
    )
    compensate.add_argument("--quiet", action="store_true", help="no progress")
    return compensate


def add_check(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> argparse.ArgumentParser:
    """`check`: the controller alone."""
    check = commands.add_parser("check", help="check a program without machine and metal")
    check.add_argument("target", type=Path, metavar="JOB_or_PROGRAM")
    check.add_argument("--setup", choices=("hobbing", "tilted"), help="of a bare program (default: hobbing)")
    check.add_argument("--parameter", action="append", default=[], metavar="8200#0=1")
    check.add_argument("--signal", action="append", default=[], metavar="NOZAGC=1")
    _add_events(check)
    check.add_argument("--keep-going", action="store_true", help="read on behind the first alarm")
    check.add_argument("--trace", action="store_true", help="print the canonical trace")
    check.add_argument("--strict", action="store_true", help="warnings are findings too")
    check.add_argument("--format", choices=("text", "json", "github"), default="text")
    return check


def _add_events(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--event",
        action="append",
        default=[],
        metavar="EVENT",
        help='what the operator does: "3.0 feed hold", "line 12 reset"',
    )


def add_inspect(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> argparse.ArgumentParser:
    """`inspect`: any mesh."""
    inspect = commands.add_parser("inspect", help="measure a mesh")
    inspect.add_argument("mesh", type=Path, metavar="MESH", help="STL, 3MF, GLB, PLY or OBJ")
    inspect.add_argument(
        "--units",
        choices=("mm", "cm", "m", "um", "inch", "ft"),
        help="of the file (default: what it declares, else mm)",
    )
    inspect.add_argument(
        "--find-axis", action="store_true", help="measure about the bore or tip circle, not about Z"
    )
    inspect.add_argument("--job", type=Path, metavar="JOB", help="take the nominal from a job")
    inspect.add_argument("--teeth", type=int)
    inspect.add_argument("--module", type=float, metavar="MM")
    inspect.add_argument("--helix", type=float, metavar="DEG", help="+ right-hand")
    inspect.add_argument("--profile-shift", type=float, metavar="X")
    inspect.add_argument("--pressure-angle", type=float, metavar="DEG", help="normal (default: 20)")
    inspect.add_argument("--tip-diameter", type=float, metavar="MM")
    inspect.add_argument("--face-width", type=float, metavar="MM")
    inspect.add_argument("--pin-diameter", type=float, metavar="MM", help="of the balls to measure over")
    inspect.add_argument("--class", type=int, dest="accuracy_class", metavar="A", help="ISO 1328-1 class")
    inspect.add_argument(
        "--teeth-to-measure", metavar="1,6,11,16", help="teeth to trace, or all (default: four)"
    )
    inspect.add_argument("--csv", type=Path, metavar="FILE", help="write the points of all traces")
    inspect.add_argument("--sides", type=int)
    inspect.add_argument("--across-flats", type=float, metavar="MM")
    inspect.add_argument("--tolerance", metavar="h13", help="of the width across flats (default: h13)")
    inspect.add_argument(
        "--against", type=Path, metavar="MESH", help="compare with another mesh: surfaces and figures"
    )
    inspect.add_argument(
        "--against-units", choices=("mm", "cm", "m", "um", "inch", "ft"), help="of that file"
    )
    inspect.add_argument(
        "--tolerance-um", type=float, metavar="UM", help="a surface that differs by more is a finding"
    )
    inspect.add_argument("--report", type=Path, metavar="FILE", help="write the comparison as an HTML page")
    inspect.add_argument("--format", choices=("text", "json"), default="text")
    return inspect


def add_explain(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> argparse.ArgumentParser:
    """`explain`: the tables."""
    explain = commands.add_parser("explain", help="what a code, alarm, parameter, signal or event means")
    explain.add_argument("name", nargs="*", metavar="NAME", help="PS1594, G81, 201#4, NOZAGC, feed hold, …")
    explain.add_argument("--all", action="store_true", help="everything, in full")
    explain.add_argument("--format", choices=("text", "json", "markdown"), default="text")
    return explain


def add_new(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> argparse.ArgumentParser:
    """`new`: drafts."""
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
    gear.add_argument("--gashes", type=int, help="(default: by module and class)")
    gear.add_argument("--starts", type=int, default=1)
    gear.add_argument("--cutting-speed", type=float, default=60.0, metavar="M/MIN")
    gear.add_argument("--feed", type=float, metavar="MM", help="per turn of the work (default: by class)")
    polygon = parts.add_parser("polygon", help="flats turned with a head of inserts")
    polygon.add_argument("--sides", type=int, required=True)
    polygon.add_argument("--across-flats", type=float, required=True, metavar="MM")
    polygon.add_argument("--length", type=float, default=10.0, metavar="MM")
    polygon.add_argument("--inserts", type=int, help="(default: half the sides, rounded up)")
    polygon.add_argument("--tip-radius", type=float, metavar="MM", help="of the head (default: by flatness)")
    polygon.add_argument("--speed", type=int, default=300, metavar="RPM", help="of the work")
    polygon.add_argument("--feed", type=float, default=0.5, metavar="MM", help="per turn of the work")
    for part in (gear, polygon):
        part.add_argument("--out", type=Path, required=True, metavar="DIR", help="new or empty folder")
    return new


def add_bench(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> argparse.ArgumentParser:
    """`bench`: how fast it is here."""
    bench = commands.add_parser("bench", help="time a part of the twin; one JSON line")
    bench.add_argument("what", choices=("kernel",), help="the cutting kernel, against booleans")
    bench.add_argument(
        "--case", default="spur_m2_z20_b20", metavar="NAME", help="a cut (default: spur_m2_z20_b20)"
    )
    return bench


def add_machine(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> argparse.ArgumentParser:
    """`machine`: its drives."""
    machine = commands.add_parser("machine", help="step and frequency response of every axis")
    machine.add_argument(
        "machine", metavar="MODEL_or_JOB", help="a model, for example hobbing_lathe, or a job with its drives"
    )
    machine.add_argument(
        "--out", type=Path, metavar="FILE", help="of the picture (default: out/…_drives.svg)"
    )
    return machine
