"""The canonical trace: one stable line per typed command, in programmed units."""

import re
from pathlib import Path
from typing import get_args

import pytest

from controller.commands import Arc, Command, Feed, Move, ReferenceReturn, Skip, StrokeCheck, Thread
from controller.dry_run import dry_run
from controller.language.source import Program, load_program, parse_program
from controller.span import Span
from controller.tables.machine_data import machine_data
from controller.tables.parameters import delivered
from controller.trace import number, trace_alarm, trace_line

PROGRAMS = Path(__file__).parents[1] / "programs"
MACHINE = machine_data(delivered())
HERE = Span(file="program.nc", line=12)


def traced(program: Program) -> str:
    lines: list[str] = []
    found = dry_run(
        program,
        MACHINE.parameters,
        observe=lambda seen: lines.append(trace_line(seen.command, seen.span, MACHINE, program.file)),
    )
    lines += [trace_alarm(alarm, program.file) for alarm in found.alarms]
    return "".join(f"{line}\n" for line in lines)


@pytest.mark.parametrize("path", sorted((PROGRAMS / "ok").glob("*.nc")), ids=lambda path: path.stem)
def test_the_trace_beside_the_program_is_the_trace_of_the_program(path: Path) -> None:
    """`hobtwin check PROGRAM --trace > PROGRAM.trace` writes it anew."""
    assert traced(load_program(path)) == path.with_suffix(".trace").read_text(encoding="utf-8")


def test_a_trace_worked_by_hand() -> None:
    """Diameters, increments, feeds and gear boxes as the programmer wrote them."""
    text = """O1
G28 U0 W0
G28 H0 V0
G00 X80. Z5.
G81 T20 L-1 Q2. P20.
S300
G98 G01 X37.5 F200.
G99 W-30. F2.
H18. F1.
S0
G80
G04 P1500
G50 X100.
T0101
M08
M30
"""
    # k · 360° · sin P / (π T Q) = −360 · 0.342020 / (40 π) = −0.9798 °/mm (rulings, section 2)
    assert (
        traced(parse_program(text))
        == """\
     2  REFERENCE       X Z P1
     3  REFERENCE       Y C P1
     4  RAPID           X80.000 Z5.000
     5  COUPLE          INTERPOLATED C=Y*-1/20 Z*-0.9798deg/mm
     6  SPINDLE         Y S300.000
     7  FEED            X37.500 F200.000/min
     8  FEED            W-30.000 F2.000/rev
     9  FEED            H18.000 F1.000/rev
    10  SPINDLE         Y S0.000 WAIT
    11  UNCOUPLE
    12  DWELL           1.500s
    13  SET             X100.000
    14  TOOL            T1
    15  COOLANT         ON
    16  END
"""
    )


def test_an_alarm_ends_the_trace() -> None:
    assert traced(parse_program("O1\nG00 X1.\nG01 X2.\nM30\n")) == (
        "     2  RAPID           X1.000\n     3  ALARM           PS0011\n"
    )


@pytest.mark.parametrize(
    ("command", "expected"),
    [
        (
            Arc(
                absolute={0: 20.0, 1: -10.0},
                incremental={},
                plane=(1, 0),
                centre=(-5.0, 0.25),
                clockwise=True,
                feed=Feed(value=2.0),
                places={},
            ),
            "ARC_CW          X40.000 Z-10.000 I0.250 K-5.000 F120.000/min",
        ),
        (
            Thread(absolute={}, incremental={1: -20.0}, lead=1.5, start_angle=180.0, places={}),
            "THREAD          W-20.000 F1.500/rev Q180.000",
        ),
        (
            Skip(move=Move(absolute={0: -1e-9}, incremental={}, feed=Feed(value=1.0), places={})),
            "SKIP            X0.000 F60.000/min",
        ),
        (ReferenceReturn(axes=(1, 0), span=HERE, point=2), "REFERENCE       X Z P2"),
        (StrokeCheck(on=False), "STROKE_CHECK    OFF"),
        (
            StrokeCheck(on=True, area={1: (-50.0, 0.0), 0: (-10.0, 20.0)}),
            "STROKE_CHECK    ON X-20.000..40.000 Z-50.000..0.000",
        ),
    ],
)
def test_commands_in_programmed_units(command: Command, expected: str) -> None:
    """A diameter axis in diameter, centres of arcs in radius (rulings, section 1, Addresses)."""
    assert trace_line(command, HERE, MACHINE, "program.nc") == f"    12  {expected}"


def test_another_file_is_named() -> None:
    span = Span(file="/somewhere/O0077.nc", line=3)
    move = Move(absolute={0: 1.0}, incremental={}, feed=None, places={})
    assert trace_line(move, span, MACHINE, "main.nc") == "O0077.nc:3  RAPID           X2.000"


def test_every_command_has_its_line() -> None:
    """No command type falls through: each has its own function."""
    from controller.trace import _said

    for kind in get_args(Command):
        assert kind in _said.registry, kind


def test_numbers_have_fixed_decimals_and_no_minus_zero() -> None:
    assert [number(v) for v in (-0.0, -0.0004, 1.0, -2.3456, 1e5)] == [
        "0.000",
        "0.000",
        "1.000",
        "-2.346",
        "100000.000",
    ]
    assert not re.search(r"-0\.0+\b", "".join(number(v) for v in (-1e-12, -4.9e-4)))
