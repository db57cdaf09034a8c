"""Feeds, rapid, dwell and the work spindle out of sync."""

import math

import numpy as np
import pytest

from controller.clock import Feedback
from controller.cnc import Controller
from controller.language.source import parse_program
from controller.tables.parameters import delivered

SLIDE = 2000.0
"""[mm/s²] delivered acceleration"""


def travel_time(length: float, speed: float, rate: float = SLIDE) -> float:
    """Textbook time from rest to rest."""
    if length < speed * speed / rate:
        return 2.0 * math.sqrt(length / rate)
    return length / speed + speed / rate


@pytest.mark.parametrize(
    ("block", "length", "speed", "rate"),
    [
        ("G01 Z-100. F600", 100.0, 10.0, SLIDE),
        ("G01 X-100. F600", 50.0, 10.0, SLIDE),
        ("G01 X-60. Z-40. F600", 50.0, 10.0, SLIDE / 0.8),
        ("G00 Z-100.", 100.0, 250.0, SLIDE),
        ("G00 X-100.", 50.0, 200.0, SLIDE),
        ("G00 Z-300. X-300.", 300.0, 250.0, SLIDE),
        ("G01 H90. F3600", 90.0, 60.0, 3600.0),
        ("G00 H90.", 90.0, 600.0, 3600.0),
    ],
)
def test_time_of_a_straight_move(run, block: str, length: float, speed: float, rate: float) -> None:
    """F is the speed along the path with X in radius; rapid moves as fast as the first axis allows."""
    assert run(f"{block}\nM30").cycle_time_s == pytest.approx(travel_time(length, speed, rate), rel=1e-9)


def test_inch_feed_and_way(run) -> None:
    """G20: ways and feeds in inches, truncated to 0.0001 inch."""
    result = run("G20 G01 Z-1.00009 F10.\nM30")
    assert result.machine["Z"] == pytest.approx(-25.4, abs=1e-9)
    assert result.cycle_time_s == pytest.approx(travel_time(25.4, 254 / 60), rel=1e-9)


@pytest.mark.parametrize(("block", "seconds"), [("G04 X1.5", 1.5), ("G04 U0.25", 0.25), ("G04 P1500", 1.5)])
def test_dwell(run, block: str, seconds: float) -> None:
    """G04 X1.0/U1.0 seconds, P1000 milliseconds."""
    assert run(f"{block}\nM30").cycle_time_s == seconds


def test_dwell_in_increments(run) -> None:
    """DPI = 0: X1500 is 1500 increments of 0.001 s."""
    assert run("G04 X1500\nM30", parameters={"3401#0": 0}).cycle_time_s == 1.5


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("G01 X-5.", "PS0011"),
        ("G01 X-5. F0", "PS0011"),
        ("G01 X-5. F-1", "PS0006"),
        ("G01 X-5. F100\nG99 G01 X-6.", "PS0011"),
        ("G99 G01 X-5. F0.1", "HT9007"),
        ("M03 S100\nM05\nG99 G01 X-5. F0.1", "HT9007"),
        ("G81 T20\nG99 G01 Z-5. F0.1", "HT9007"),
        ("G81 T20\nS100\nS0\nG99 G01 Z-5. F0.1", "HT9007"),
        ("G04", "HT9012"),
        ("G04 X-1.", "PS0006"),
        ("G04 P1.5", "PS0007"),
        ("M03", "PS1541"),
        ("M03 S0", "PS1541"),
        ("M03 S100\nS0", "PS1541"),
        ("S-100", "PS0006"),
        ("S100.5", "PS0007"),
        ("S2001", "PS1544"),
        ("G50 S0", "PS1541"),
        ("M03 S100\nC90.", "PS0197"),
        ("M03 S100\nM05\nC90.", "PS0197"),
        ("M03 S100\nM05\nG28 H10.", "PS0197"),
        ("M03 S100\nM19\nC90.", None),
        ("M03 S100\nG28 H0\nC90.", None),
        ("G96 M03", "PS1541"),
        ("G00 X99999.999", "OT0500"),
    ],
)
def test_what_is_refused(alarm_of, text: str, number: str | None) -> None:
    assert alarm_of(f"{text}\nM30") == number


@pytest.mark.parametrize("theoretical", [0, 1])
def test_feed_per_turn_of_the_work_in_sync(drive, run, theoretical: int) -> None:
    """G99 in sync: F per revolution of the *work* axis; the ramp is waited for; 300 rpm, T20: 15 rpm · 2
    mm = 30
    mm/min. By the measured speed of an ideal machine the same."""
    text = "G81 T20 L1\nS300\nG99 G01 Z-2. F2.\nS0\nG80\nM30"
    driven = drive(text, parameters={"201#2": theoretical})
    z, c = driven.axis("Z"), driven.axis("C")
    middle = slice(1500, 3500)
    assert np.polyfit(c[middle] / 360, z[middle], 1)[0] == pytest.approx(-2.0, rel=1e-6)
    first = int(np.flatnonzero(np.diff(z))[0])
    assert first == pytest.approx(500, abs=1)
    expected = 0.5 + travel_time(2.0, 0.5) + 0.5
    assert len(z) == pytest.approx(1000 * expected, abs=9)
    assert run(text).cycle_time_s == pytest.approx(expected, rel=1e-9)


def test_feed_follows_the_measured_speed(drive) -> None:
    """201#2 = 0: the feed follows what the encoder says, not what was commanded: at half the speed half
    the feed."""

    class Slipping:
        """The work spindle's encoder says half of what is commanded."""

        def advance(self, chunk):
            actual = np.array(chunk.setpoint)
            actual[:, 3] *= 0.5
            return Feedback(ticks=chunk.ticks, setpoint=chunk.setpoint, actual=actual)

    text = "G81 T20 L1\nS300\nG99 G01 Z-1. F2.\nS0\nG80\nM30"
    slow = drive(text, drives=Slipping())
    speed = np.diff(slow.axis("Z"))[1000:2000] * 60_000
    assert speed == pytest.approx(-15.0, rel=1e-6)
    theoretical = drive(text, drives=Slipping(), parameters={"201#2": 1})
    assert np.diff(theoretical.axis("Z"))[700:1500] * 60_000 == pytest.approx(-30.0, rel=1e-6)


def test_a_stalled_work_spindle_is_an_alarm_not_a_wait(drive) -> None:
    """Work axis standing still with a G99 feed move pending: alarm naming the cause."""

    class Blocked:
        def advance(self, chunk):
            actual = np.array(chunk.setpoint)
            actual[:, 3] = 0.0
            return Feedback(ticks=chunk.ticks, setpoint=chunk.setpoint, actual=actual)

    driven = drive("G81 T20 L1\nS300\nG99 G01 Z-1. F2.\nM30", drives=Blocked())
    assert [alarm.number for alarm in driven.controller.alarms] == ["HT9007"]
    assert len(driven.setpoint) == pytest.approx(1500, abs=10)


def test_feed_per_turn_out_of_sync(drive) -> None:
    """G99 out of sync counts turns of the work spindle: 200 rpm · 0.1 mm."""
    driven = drive("M03 S200\nG99 G01 Z-2. F0.1\nM05\nM30")
    z = driven.axis("Z")
    assert np.diff(z)[3000:3500] * 60_000 == pytest.approx(-20.0, rel=1e-6)


def test_slave_of_the_polygon_does_not_count(drive) -> None:
    """In polygon turning the work axis is the master: 60 rpm · 1 mm, not the tool's 120."""
    driven = drive("G51.2 P1 Q2\nS60\nG99 G01 Z-1. F1.\nS0\nG50.2\nM30")
    z = np.diff(driven.axis("Z"))
    assert z.min() * 60_000 == pytest.approx(-60.0, rel=1e-6)


def test_a_spindle_left_turning_by_g50_2_feeds(alarm_of) -> None:
    """The master keeps S at G50.2: feed per revolution goes on from the turning work."""
    assert alarm_of("G51.2 P1 Q2\nS60\nG50.2\nG99 G01 Z-1. F1.\nM05\nM30") is None


def test_constant_surface_speed(drive) -> None:
    """G96: n = 1000 V / (π D) with D from the absolute X, clamped by G50 S."""
    text = "G50 X100.\nG50 S800\nG96 S100 M03\nG04 X2.\nG01 X30. F300\nG04 X1.\nG97\nG04 X0.1\nM05\nM30"
    driven = drive(text)
    rpm = np.diff(driven.axis("C")) / 0.006
    diameter = 100.0 + 2.0 * driven.axis("X")[1:]
    wanted = np.minimum(800.0, 1000.0 * 100.0 / (math.pi * diameter))
    cutting = np.flatnonzero(np.diff(driven.axis("X")))[50:-50]
    assert np.abs(rpm[cutting] / wanted[cutting] - 1.0).max() < 0.005
    assert rpm.max() == pytest.approx(800.0, rel=1e-9)
    end = int(cutting[-1]) + 1100  # G97 without S keeps the speed of the moment
    assert rpm[end] == pytest.approx(800.0, rel=1e-6)


@pytest.mark.parametrize(("code", "sense"), [("M03", 1.0), ("M04", -1.0)])
def test_spindle_senses_and_ramp(drive, code: str, sense: float) -> None:
    """C+ is M03; 300 rpm in 0.5 s at 3600 deg/s²."""
    driven = drive(f"S300\n{code}\nG04 X1.\nM05\nM30")
    rpm = np.diff(driven.axis("C")) / 0.006
    assert rpm[600] == pytest.approx(sense * 300.0)
    assert rpm[250] == pytest.approx(sense * 150.0, rel=0.01)
    assert len(rpm) == pytest.approx(1500, abs=2)


def test_m30_stops_what_turns(drive) -> None:
    driven = drive("S300 M03\nG04 X1.\nM30")
    assert np.diff(driven.axis("C"))[-1] <= 0.5 * 3600 * 1e-6 * (1 + 1e-6)


def test_too_fast_a_feed_is_slowed_and_said(run) -> None:
    result = run("G01 Z-300. F20000\nM30")
    assert [w.number for w in result.warnings] == ["HT9107"]
    assert result.cycle_time_s == pytest.approx(travel_time(300.0, 8000 / 60), rel=1e-9)


@pytest.mark.parametrize(("theoretical", "longest"), [(0, 8), (1, 4096)])
def test_chunks_of_a_measured_feed_end_with_its_period(theoretical: int, longest: int) -> None:
    """G99 by measured speed proposes at most its update period of 8 ms; by theoretical speed the limit."""
    parameters = delivered("hobbing", {"201#2": theoretical})
    program = parse_program("G81 T20 L1\nS300\nG99 G01 Z-3. F2.\nS0\nG80\nM30")
    controller = Controller(program, parameters=parameters)
    sizes = []
    while (chunk := controller.propose(4096)).ticks:
        if controller.blocks[chunk.block[-1]].text.startswith("G99"):
            sizes.append(chunk.ticks)
        controller.commit(Feedback(ticks=chunk.ticks, setpoint=chunk.setpoint, actual=chunk.setpoint))
    assert max(sizes[1:-1], default=sizes[0]) == longest
