"""What a dry run reports beside alarms and positions: peaks, times of blocks, stretches in sync, commands."""

import math
from itertools import pairwise

import numpy as np
import pytest

from controller.commands import Move, ProgramEnd, SpindleSpeed
from controller.dry_run import dry_run
from controller.language.source import parse_program
from controller.laws.gearbox import SyncKind
from controller.observed import Observed
from controller.operator.actions import read_event
from controller.tables.parameters import delivered


def test_peaks_of_slides(run) -> None:
    """X in radius: F1000 along X 3, Z 4 is 600 and 800; the quickest way of both is limited by X."""
    found = run("G01 X-60. Z-40. F1000\nG01 Z-45. F10\nM30").peaks
    assert (found["X"].speed, found["Z"].speed) == (pytest.approx(600.0), pytest.approx(800.0))
    assert found["X"].acceleration == pytest.approx(1500.0)
    assert found["Z"].acceleration == pytest.approx(2000.0)
    assert (found["X"].speed_limit, found["Z"].speed_limit) == (12000.0, 15000.0)
    assert (found["X"].acceleration_limit, found["C"].speed) == (2000.0, 0.0)


def test_a_short_move_never_reaches_its_feed(run) -> None:
    """v = √(a s) on a way too short for F."""
    assert run("G01 Z-0.1 F8000\nM30").peaks["Z"].speed == pytest.approx(60.0 * math.sqrt(2000.0 * 0.1))


def test_peaks_in_sync_are_those_of_both(run) -> None:
    """Hob 300, work 15 rpm by the ratio; the helical shift adds −k' v while Z moves down."""
    found = run("G81 T20 L1 Q2. P20.\nS300\nG04 X1.\nG01 Z-20. F900\nS0\nG80\nM30").peaks
    rate = -360 * math.sin(math.radians(20)) / (math.pi * 20 * 2)
    shift = rate * -15.0 / 6.0  # [rpm]
    assert shift > 0.0
    assert found["Y"].speed == pytest.approx(300.0, rel=1e-12)
    assert found["C"].speed == pytest.approx(15.0 + shift, rel=1e-9)
    assert (found["Y"].speed_limit, found["C"].speed_limit) == (4000.0, 2000.0)


def test_peaks_agree_with_the_sampled_motion(drive) -> None:
    text = (
        "G81 T20 L1 Q2. P20.\nS300\nG01 X-20. Z-9. F900\nG03 X0 Z-19. R20. F700\nS-100\nG00 Z0\nS0\nG80\nM30"
    )
    driven = drive(text, tick_s=0.00025)
    speed = np.abs(np.diff(driven.setpoint, axis=0)).max(axis=0) / 0.00025
    peaks = dry_run(parse_program(text), delivered()).peaks
    for k, letter in enumerate("XZYC"):
        unit = 60.0 if letter in "XZ" else 1.0 / 6.0
        assert speed[k] * unit <= peaks[letter].speed * (1 + 1e-6)
        assert speed[k] * unit == pytest.approx(peaks[letter].speed, rel=0.02)


def test_blocks_fill_the_cycle(run) -> None:
    found = run("G04 X1.\n\n(comment)\nG01 Z-10. F600\nM98 P7 L2\nM30\nO7\nG04 X0.5\nM99")
    assert found.blocks.line.tolist() == [1, 4, 5, 8, 9, 8, 9, 6]
    assert sum(found.blocks.duration_s) == pytest.approx(found.cycle_time_s, rel=1e-12)
    assert found.blocks.start_s[0] == 0.0
    assert found.blocks.duration_s[1] == pytest.approx(1.005)


def test_sync_intervals(run) -> None:
    """Where sync is on: kind, times, lines; a new G81 in sync goes on in the same stretch."""
    text = "G04 X1.\nG81 T20\nG04 X2.\nG81 T40\nG04 X1.\nG80\nG51.2 P1 Q2\nS60\nM05\nG04 X3.\nG01 Q1"
    found = run(text, parameters={"201#4": 1})
    one, two = found.sync
    assert (one.kind, one.first_line, one.last_line) == (SyncKind.HOBBING, 2, 6)
    assert (one.start_s, one.end_s) == (1.0, 4.0)
    assert (two.kind, two.first_line, two.last_line) == (SyncKind.POLYGON, 7, None)
    assert two.end_s == found.cycle_time_s
    assert found.in_sync_at_end
    assert found.alarms[0].number == "PS0009"


def test_observed_commands() -> None:
    """One record a command, in order, contiguous, in slide millimetres."""
    seen: list[Observed] = []
    text = "G50 X100. Z50.\nG81 T20\nS300\nG01 X80. Z40. F600\nM30"
    dry_run(parse_program(text), delivered(), observe=seen.append)
    assert [type(one.command).__name__ for one in seen] == [
        "SetCoordinates",
        "Couple",
        "SpindleSpeed",
        "Move",
    ]
    move = seen[-1]
    assert isinstance(move.command, Move)
    assert (move.span.line, move.start_s) == (4, 0.0)
    assert (move.absolute_before[:2], move.absolute_after[:2]) == ((50.0, 50.0), (40.0, 40.0))
    assert move.slides_after[:2] == (-10.0, -10.0)
    assert move.gear is not None
    assert move.master_rpm == 300.0
    assert move.end_s == pytest.approx(math.hypot(10, 10) / 10.0 + 10.0 / (2000.0 * math.sqrt(2)), rel=1e-9)
    for one, other in pairwise(seen):
        assert other.start_s >= one.end_s
        assert other.absolute_before == one.absolute_after


def test_nothing_is_observed_of_a_command_in_alarm() -> None:
    seen: list[Observed] = []
    dry_run(parse_program("G00 Z-5.\nG01 Z-5000. F900\nM30"), delivered(), observe=seen.append)
    assert [type(one.command) for one in seen] == [Move]
    seen.clear()
    dry_run(parse_program("S100 M03\nM30"), delivered(), observe=seen.append)
    assert [type(one.command) for one in seen] == [SpindleSpeed, ProgramEnd]


def test_output_signals_at_the_end(run) -> None:
    found = run("G28 U0 W0\nG81 T20\nS60\nG04 X1.").signals
    assert found["ZPX"] is found["ZPZ"] is True
    assert found["MVX"] is False
    assert run("G81 T20\nS60\nG04 X1.\nG01 Q1").signals["MVC"] is True


def test_started_again_after_its_end() -> None:
    """Cycle start at the end of the program runs it from its beginning; absolutes stay true."""
    text = "G00 X-10.\nG81 T20\nS60\nG01 W-5. F600\nS0\nG80\nG28 H0 V0\nM30"
    once = dry_run(parse_program(text), delivered())
    twice = dry_run(parse_program(text), delivered(), events=[read_event("60 cycle start")])
    assert twice.alarms == twice.warnings == ()
    assert len(twice.blocks.line) == 2 * len(once.blocks.line)
    assert twice.absolute["Z"] == twice.machine["Z"] == -10.0
    assert [interval.first_line for interval in twice.sync] == [2, 2]
