"""A gear box and what would break it: limits of the slave, servos, detached axes, analogue spindles."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from controller.dry_run import DryRun, dry_run
from controller.language.source import parse_program
from controller.operator.actions import read_event
from controller.tables.parameters import delivered

HELICAL = "G81 T2 L1 Q2. P45.\nS3600\nG04 X7.\n"
SHIFT = 360.0 * math.sin(math.radians(45.0)) / (math.pi * 2.0 * 2.0)
"""[deg/mm] of the slave by Z travel: 20.257"""
MOTIONS = ("G01 W{}60. F1700", "G01 W{}60. U20. F1700", "G02 W{}60. U0 R40. F1700")


def act(text: str, *events: str, parameters=None, signals=None) -> DryRun:
    return dry_run(
        parse_program(text + "\nM30"),
        delivered(overrides=parameters),
        signals=signals,
        events=[read_event(event) for event in events],
    )


def first_alarm(found: DryRun) -> str | None:
    return found.alarms[0].number if found.alarms else None


def test_raised_override_leaves_the_slave_its_limit() -> None:
    """At 3600 rpm the work turns at 1800; 1700 mm/min of Z add 95.7 rpm. 109 % makes that 1962 and leaves 38
    rpm, 228 deg/s: 11.26 mm/s instead of 28.33."""
    text = f"{HELICAL}G01 W-60. F1700\nS0\nG80"
    plain, raised = act(text), act(text, "7.5 spindle override 109")
    assert plain.peaks["C"].speed == pytest.approx(1800.0 + 1700.0 / 60.0 * SHIFT / 6.0)
    assert raised.alarms == ()
    assert raised.peaks["C"].speed <= 2000.0 + 1e-6
    (speed,) = (w.found for w in raised.warnings if w.number == "HT9107")
    assert speed.endswith(f"{228.0 / SHIFT * 60.0:.0f} possible on this path")
    (feed,) = (k for k, line in enumerate(raised.blocks.line) if line == 4)
    assert raised.blocks.duration_s[feed] > plain.blocks.duration_s[feed] + 1.5


@given(
    time=st.floats(5.0, 9.5),
    percent=st.integers(50, 111),
    motion=st.sampled_from(MOTIONS),
    way=st.sampled_from("-+"),
    sense=st.sampled_from("-+"),
)
@settings(max_examples=40, deadline=None)
def test_no_override_drives_the_slave_past_its_limit(
    time: float, percent: int, motion: str, way: str, sense: str
) -> None:
    """Whatever the override, the direction and the path are, the work stays within parameter 3772."""
    text = HELICAL.replace("S3600", f"S{sense}3600") + motion.format(way) + "\nS0\nG80"
    found = act(text, f"{time:.3f} spindle override {percent}")
    assert found.alarms == ()
    assert found.peaks["C"].speed <= 2000.0 + 1e-6


def test_an_override_that_leaves_nothing_stops_the_feed_first() -> None:
    """S3600 at 115 % is 2070 rpm of the work, held at 2000: nothing is left for Z. It brakes, then PS1596."""
    found = act(f"{HELICAL}G01 W-60. F1700\nS0\nG80", "7.5 spindle override 115")
    assert first_alarm(found) == "PS1596"
    assert found.peaks["C"].speed <= 2000.0 + 1e-6
    assert found.peaks["Z"].acceleration <= 2000.0 + 1e-6


@pytest.mark.parametrize(("gear", "off"), [("G81 T20 L1", "G80"), ("G51.2 P1 Q2", "G50.2")])
@pytest.mark.parametrize("signal", ["SVFY", "SVFC", "DTCHY", "DTCHC"])
def test_sync_axes_keep_their_servos(gear: str, off: str, signal: str) -> None:
    """In sync servo off and detaching of master and slave are refused, and change nothing; of others not."""
    text = f"{gear}\nS60\nG01 Z-5. F60\nS0\n{off}"
    plain = act(text, "0.1 signal BDT9=1")
    found = act(text, f"2.0 signal {signal}=1")
    assert [w.number for w in found.warnings] == ["HT9131"]
    assert found.absolute == pytest.approx(plain.absolute, abs=1e-5)
    assert found.cycle_time_s == pytest.approx(plain.cycle_time_s, rel=1e-12)
    assert act(text, "2.0 signal SVFX=1").warnings == ()


@pytest.mark.parametrize("gear", ["G81 T20 L1", "G51.2 P1 Q2"])
@pytest.mark.parametrize(("signal", "number"), [("SVFY", "PS0197"), ("SVFC", "PS0197"), ("DTCHC", "PS0009")])
def test_no_gear_box_without_servos(gear: str, signal: str, number: str) -> None:
    found = act(gear, signals={signal: True})
    assert (first_alarm(found), found.in_sync_at_end) == (number, False)


@pytest.mark.parametrize(
    ("analogue", "follow", "encoder", "gear", "number"),
    [
        ("Y", 1, 1, "G81 T20 L1", None),
        ("Y", 1, 0, "G81 T20 L1", "PS1593"),
        ("Y", 0, 1, "G81 T20 L1", "PS0197"),
        ("C", 1, 1, "G81 T20 L1", "PS1593"),
        ("C", 1, 1, "G51.2 P1 Q2", None),
        ("C", 1, 0, "G51.2 P1 Q2", "PS1593"),
        ("C", 0, 1, "G51.2 P1 Q2", "PS0197"),
        ("Y", 1, 1, "G51.2 P1 Q2", "PS1593"),
    ],
)
def test_analogue_master(analogue: str, follow: int, encoder: int, gear: str, number: str | None) -> None:
    """Rulings, section 2: the interpolated type needs both axes in position control (PS0197), the follow type
    allows an analogue master with an encoder, else PS1593; an analogue slave has nothing to follow with."""
    parameters = {"201#7": follow, f"9005#0.{analogue}": 1, f"9005#1.{analogue}": encoder}
    off = "G80" if "G81" in gear else "G50.2"
    assert first_alarm(act(f"{gear}\n{off}", parameters=parameters)) == number


@pytest.mark.parametrize("block", ["C90.", "G28 H0", "M19", "G53 C0", "M03 S10\nM05\nG28 H0"])
def test_an_analogue_spindle_has_no_position(block: str) -> None:
    assert first_alarm(act(block, parameters={"9005#0.C": 1})) == "PS0197"
    assert first_alarm(act("M03 S100\nG99 G01 Z-5. F1.\nM05", parameters={"9005#0.C": 1})) is None


@pytest.mark.parametrize("block", ["G99 G01 Z-5. F1.", "G32 Z-5. F1.", "G99 G31 Z-5. F1."])
def test_a_feed_per_turn_needs_an_encoder(block: str) -> None:
    assert first_alarm(act(f"M03 S100\n{block}\nM05", parameters={"9005#1.C": 0})) == "HT9005"


@pytest.mark.parametrize(
    ("block", "column"),
    [
        ("G00 X1. Z1. Y1. C1.", 17),
        ("G01 U1. C1. W1. V1. F1", 17),
        ("G28 U0 W0 H0 V0", 14),
        ("G53 X0 Z0 Y0 C0", 14),
        ("G02 X2. Z-2. R5. Y1. C1. F1", 22),
    ],
)
def test_more_axes_than_the_control_moves_together(block: str, column: int) -> None:
    """PS0015 at the last of them; as delivered all axes of the machine move together."""
    (alarm,) = act(block, parameters={"9004": 3}).alarms
    assert (alarm.number, alarm.span and alarm.span.column) == ("PS0015", column)
    assert first_alarm(act(block)) is None
    assert first_alarm(act("G00 X1. Z1.", parameters={"9004": 1})) == "PS0015"


def test_stopped_spindle_shows_where_it_stands() -> None:
    """600 deg/s after 1/6 s: 50° + 500° in the rest of the second + 50° to the stop: 600°."""
    for end in ("M05", ""):
        found = act(f"M03 S100\nG04 X1.\n{end}")
        assert (found.absolute["C"], found.machine["C"]) == pytest.approx((240.0, 240.0))
