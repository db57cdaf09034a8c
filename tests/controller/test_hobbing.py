"""Rulings, section 2 (hobbing original): every test names the sentence it holds the controller to."""

import math
from fractions import Fraction

import numpy as np
import pytest

from controller.execution import Execution
from controller.language.offsets import Offsets
from controller.language.source import parse_program
from controller.motion.axes import Circumstances
from controller.motion.sampling import setpoints
from controller.tables.parameters import delivered

HOME = "G28 U0 W0\nG28 H0 V0\n"
FOLLOW = {"201#7": 1}
ECN = {"201#4": 1}


@pytest.mark.parametrize(
    ("block", "ratio"),
    [("G81 T20 L1", 1 / 20), ("G81 T20", 1 / 20), ("G81 T30 L-3", -1 / 10), ("G81 T1 L4", 4.0)],
)
@pytest.mark.parametrize("speed", [300, -300])
def test_ratio_and_direction(run, block: str, ratio: float, speed: int) -> None:
    """Hob turns once, work turns L/T; L omitted = 1; sgn(C) = sgn(L)·sgn(S)."""
    result = run(f"{HOME}{block}\nS{speed}\nG04 X10.\nS0\nG80\nM30")
    assert result.alarms == ()
    # work 1200 rpm at most 3600 deg/s² : the hob ramps with the smaller of both accelerations
    rate = 3600.0 * min(1.0, 1.0 / abs(ratio))
    ramp = 1800.0 / rate
    turns = math.copysign(5.0 * (10.0 + ramp) - 5.0 * ramp + 5.0 * ramp / 2 - 5.0 * ramp / 2, speed)
    assert result.turns["Y"] == pytest.approx(turns, rel=1e-12)
    assert result.turns["C"] == pytest.approx(turns * ratio, rel=1e-12)


def test_setpoints_keep_the_ratio_at_every_tick(drive) -> None:
    """Interpolated type: slave setpoint = ratio × master setpoint, at every tick and through the ramps."""
    driven = drive("G81 T20 L3\nS400\nG04 X3.\nS-100\nG04 X2.\nS0\nG80\nM30")
    hob, work = driven.axis("Y"), driven.axis("C")
    assert np.abs(work - hob * 3 / 20).max() <= np.spacing(np.abs(hob).max())
    assert np.abs(hob).max() > 5000.0


def test_commanded_error_after_a_million_hob_turns_is_zero() -> None:
    """300 rpm after a ramp of 0.5 s: 10⁶ turns are complete 200 000.25 s after S300. There, sampled from the
    closed form of every chunk, the error is zero; at random ticks on the way never more than rounding."""
    text = "G81 T20 L1\nS300\nG04 X99999.\nG04 X99999.\nG04 X9.\nS0\nG80\nM30"
    circumstances = Circumstances(rate=1000, closed_form=True)
    execution = Execution(parse_program(text), delivered(), Offsets(), {}, circumstances=circumstances)
    while not execution.done:
        execution.step()
    timeline = execution.motion.timeline
    hob, work = setpoints(timeline, np.array([200_000.25]))[0, 2:4]
    assert hob == 360e6
    assert work * 20 == hob
    ticks = np.sort(np.random.default_rng(1).integers(0, 200_000_000, 10_000)) / 1000.0
    hob, work = setpoints(timeline, ticks)[:, 2:4].T
    error = [abs(Fraction(c) * 20 - Fraction(y)) for c, y in zip(work.tolist(), hob.tolist(), strict=True)]
    assert max(error) <= 20 * Fraction(math.ulp(18e6))


def test_no_ramp_on_the_coupling_phase_is_what_both_hold(run) -> None:
    """The phase is what both axes hold when G81 completes: C stays at 30 with the hob at 50."""
    result = run("G00 C30. Y50.\nG81 T20 L1\nS300\nG04 X2.\nS0\nG80\nM30")
    assert result.turns["C"] * 360 - 30 == pytest.approx((result.turns["Y"] * 360 - 50) / 20, rel=1e-12)


def test_s_is_signed_and_s0_stops_and_waits(drive) -> None:
    """S0 stops the hob (never PS1541 in sync); the next block begins at standstill."""
    driven = drive("G81 T20 L1\nS300\nG04 X1.\nS0\nG01 X-10. F600\nG80\nM30")
    hob, x = driven.axis("Y"), driven.axis("X")
    moving = np.flatnonzero(np.diff(x))
    assert np.all(np.diff(hob)[moving] == 0.0)
    assert not driven.controller.alarms


def test_m05_is_s0_in_sync(run) -> None:
    by_s0 = run("G81 T20 L1\nS300\nG04 X1.\nS0\nG80\nM30")
    by_m05 = run("G81 T20 L1\nS300\nG04 X1.\nM05\nG80\nM30")
    assert (by_m05.machine, by_m05.cycle_time_s) == (by_s0.machine, by_s0.cycle_time_s)


@pytest.mark.parametrize(
    ("block", "number"),
    [
        ("G81 L1", "PS1594"),
        ("G81 T0 L1", "PS1594"),
        ("G81 T1001", "PS1594"),
        ("G81 T20.5", "PS1594"),
        ("G81 T20.", "PS1594"),
        ("G81 T20 L0", "PS1594"),
        ("G81 T20 L1001", "PS1594"),
        ("G81 T20 L-1001", "PS1594"),
        ("G81 T20 L1.5", "PS1594"),
        ("G81 T20 Q2.", "PS1594"),
        ("G81 T20 P20.", "PS1594"),
        ("G81 T20 Q0.009 P20.", "PS1594"),
        ("G81 T20 Q100.001 P20.", "PS1594"),
        ("G81 T20 Q2. P90.001", "PS1594"),
        ("G81 T20 Q2. P-90.001", "PS1594"),
        ("G81 T20 L1 X10.", "PS1594"),
        ("G81 T20 L1 H5.", "PS1594"),
        ("G81 T20 L1 S300", "PS1594"),
        ("G81 T20 L1 M08", "PS1594"),
        ("G81 T1000 L-1000 Q100. P-90.", None),
        ("G81 T1 L1000 Q0.01 P90.", None),
        ("N10 G81 T20 L1 Q2 P20", None),
    ],
)
def test_format(alarm_of, block: str, number: str | None) -> None:
    """Ranges of T, L, Q, P; not an integer; only one of P and Q; axis words: PS1594."""
    assert alarm_of(f"{block}\nG80\nM30") == number


def test_range_of_q_in_inch(alarm_of) -> None:
    """Q 0.01-254 1/in with G20."""
    assert alarm_of("G20\nG81 T20 Q254. P20.\nG80\nM30") is None
    assert alarm_of("G20\nG81 T20 Q254.001 P20.\nG80\nM30") == "PS1594"


def test_steep_helix_warns(run) -> None:
    """|P| > 85° warns."""
    assert [w.number for w in run("G81 T20 Q2. P85.\nG80\nM30").warnings] == []
    assert [w.number for w in run("G81 T20 Q2. P-85.001\nG80\nM30").warnings] == ["HT9102"]


def test_negative_s_warns(run) -> None:
    """Rulings, section 5: S < 0 while hobbing warns that the hob runs backwards."""
    assert [w.number for w in run("G81 T20\nS-10\nS0\nG80\nM30").warnings] == ["HT9101"]


@pytest.mark.parametrize(
    ("block", "number"),
    [
        ("Y90.", "PS1595"),
        ("G00 V90.", "PS1595"),
        ("G01 V90. F100", "PS1595"),
        ("M03 S100", "PS1595"),
        ("M04", "PS1595"),
        ("M19", "PS1595"),
        ("G96 S100", "PS1595"),
        ("G20", "PS1595"),
        ("G21", "PS1595"),
        ("T0101", "PS1595"),
        ("G28 H0", "PS1595"),
        ("G28 U0 V0", "PS1595"),
        ("G53 C0", "PS1595"),
        ("M30", "PS1595"),
        ("M02", "PS1595"),
        ("G51.2 P1 Q2", "PS1595"),
        ("G50.2", "PS1595"),
        ("G81 T20 L1", "PS1595"),
        ("G80 X1.", "PS1594"),
        ("G80 G00", "PS1594"),
        ("G80 M05", "PS1594"),
        ("S5000", "PS1544"),
        ("S300.5", "PS0007"),
        ("G00 C90.", None),
        ("G00 H90.", None),
        ("G00 X-5. W-5.", None),
        ("G28 U0 W0", None),
        ("N20 G80", None),
        ("M05", None),
        ("M08", None),
        ("S0", None),
    ],
)
def test_in_sync(alarm_of, block: str, number: str | None) -> None:
    """In sync: no move of the master, no G20/G21, tool change, G28 of a sync axis, M30/M02, G51.2, M03,
    M04, G96;
    G80 alone but for N; the slave and other axes freely."""
    tail = "" if block.endswith("G80") else "G80\n"
    assert alarm_of(f"{HOME}G81 T20 L1\n{block}\n{tail}M30") == number


def test_slave_absolutely_only_without_helix(alarm_of) -> None:
    """The slave may be commanded, incrementally only when helical."""
    head = "G81 T20 L1 Q2. P20.\n"
    assert alarm_of(f"{head}G00 C10.\nG80\nM30") == "PS1595"
    assert alarm_of(f"{head}G00 H10.\nG80\nM30") is None


def test_g80_out_of_sync_is_a_plain_modal_word(alarm_of) -> None:
    assert alarm_of("G40 G80 G00 X5.\nM30") is None


def test_work_too_fast(run) -> None:
    """A work axis that cannot follow is refused, with its limit."""
    (alarm,) = run("G81 T1 L1\nS2001\nM30").alarms
    assert alarm.number == "PS1596"
    assert "2000 rpm of C" in alarm.remedy


@pytest.mark.parametrize(
    ("overrides", "number"),
    [
        ({"197": 0}, "PS1593"),
        ({"197": 5}, "PS1593"),
        ({"197": 4}, "PS1593"),
        ({"198": 0}, "PS1593"),
        ({"198": 2}, "PS1593"),
        ({"197": 1}, "PS1593"),
        ({"1006#1.C": 1}, "PS1593"),
        ({"1006#1.Y": 1}, "PS1593"),
        ({"1006#0.Y": 0}, "PS1593"),
        ({"199": 0}, None),
        ({"197": 0, "201#7": 1}, None),
        ({"198": 0, "201#7": 1}, "PS1593"),
    ],
)
def test_axes_of_the_gear_box(alarm_of, overrides: dict[str, float], number: str | None) -> None:
    """Rotary type A, configured, different: else PS1593. Follow type: 197 may be unset."""
    assert alarm_of("G81 T20 L1\nG80\nM30", parameters=overrides) == number


@pytest.mark.parametrize("axial", [0, 3, 5])
def test_axial_axis_of_a_helical_gear(alarm_of, axial: int) -> None:
    """199 must name a linear axis where Q and P are given."""
    assert alarm_of("G81 T20 L1 Q2. P20.\nG80\nM30", parameters={"199": axial}) == "PS1593"


def test_helical_compensation_in_all_displays(run) -> None:
    """Registers: sync motion updates machine only; helical compensation machine, absolute and relative. k
    = −1:
    Z −20 mm at P 20 turns C by +19.596°."""
    result = run("G81 T20 L1 Q2. P20.\nG01 Z-20. F1000\nG80\nM30")
    shift = 360 * 20 * math.sin(math.radians(20)) / (math.pi * 20 * 2)
    assert result.machine["C"] == pytest.approx(shift, abs=1e-6)
    assert result.absolute["C"] == pytest.approx(shift, abs=1e-6)
    assert result.relative["C"] == pytest.approx(shift, abs=1e-6)
    turning = run("G81 T20 L1 Q2. P20.\nS300\nG01 Z-20. F1000\nS0\nG80\nM30")
    assert turning.relative["C"] == pytest.approx(shift, abs=1e-6)
    assert turning.relative["Y"] == 0.0


def test_all_axial_travel_since_g81_counts(drive) -> None:
    """ΔZ counts all Z motion since G81: rapid, feed and back; C is where Z is, at every tick."""
    driven = drive("G00 Z-5.\nG81 T20 L1 Q2. P20.\nG00 Z-30.\nG01 Z-10. F900\nG28 W0\nG80\nM30")
    rate = -360 * math.sin(math.radians(20)) / (math.pi * 20 * 2)
    z = driven.axis("Z")[driven.sync]
    assert np.abs(driven.axis("C")[driven.sync] - rate * (z + 5.0)).max() < 1e-10
    assert z.min() == pytest.approx(-30.0, abs=1e-3)  # the turning point lies between two ticks


def test_compensation_never_depends_on_the_sense_of_rotation(run) -> None:
    """k is latched at G81 and does not change when S reverses (the original's remark would ruin the
    flank)."""
    shifts = []
    for speed in (300, -300):
        result = run(f"G81 T20 L1 Q2. P20.\nS{speed}\nG01 Z-20. F1000\nS0\nG80\nM30")
        shifts.append(result.turns["C"] - result.turns["Y"] / 20)
    assert shifts[0] == pytest.approx(shifts[1], rel=1e-9)
    assert shifts[0] > 0.0


def test_g80_brings_the_absolutes_up_to_date(run) -> None:
    """Registers: G80: absolutes of slave and master += sync motion, modulo 360; not before."""
    program = "G00 C10. Y20.\nG81 T20 L1\nS300\nG04 X7.3\nS0\nC10.\n"
    before = run(program)
    assert before.absolute["C"] == 10.0
    assert before.absolute["Y"] == 20.0
    after = run(program + "G80\nM30")
    # 300 rpm: 7.3 s and one braking ramp of 0.5 s make 36.5 + 1.25 turns, less half of the first ramp
    turns = 5.0 * 7.3
    assert after.absolute["Y"] == pytest.approx((20.0 + 360.0 * turns) % 360.0, abs=1e-5)
    assert after.absolute["C"] == pytest.approx((10.0 + 18.0 * turns) % 360.0, abs=1e-5)
    assert after.machine["C"] == after.absolute["C"]


def test_absolute_moves_are_right_after_g80(run) -> None:
    """After G80 the slave goes where an absolute word says, the short way."""
    result = run("G81 T20 L1\nS300\nG04 X7.3\nS0\nG80\nG00 C90. Y45.\nM30")
    assert result.machine["C"] == pytest.approx(90.0, abs=1e-6)
    assert result.machine["Y"] == pytest.approx(45.0, abs=1e-6)


def test_slave_motion_adds_to_the_sync_motion(run) -> None:
    result = run("G81 T20 L1\nS300\nG00 H25.\nG04 X2.\nS0\nG80\nM30")
    assert result.turns["C"] * 360 - 25 == pytest.approx(result.turns["Y"] * 18, rel=1e-12)


def test_g80_while_turning_brakes_the_slave(drive) -> None:
    """Ends: the slave brakes, its braking travel counts; the master keeps S."""
    driven = drive("G81 T2 L1\nS300\nG04 X1.\nG80\nG04 X1.\nM30")
    hob, work = np.diff(driven.axis("Y")), np.diff(driven.axis("C"))
    released = int(np.flatnonzero(driven.sync)[-1])
    assert hob[released + 500] == pytest.approx(1.8, rel=1e-9)
    assert work[released + 500] == pytest.approx(0.0, abs=1e-12)
    assert np.abs(np.diff(work)).max() <= 3600.0 * 1e-6 * (1 + 1e-6)
    slow = work[released : released + 260]
    assert slow.sum() == pytest.approx(0.5 * 900.0**2 / 3600.0, abs=0.9)


def test_released_master_needs_orientation(run, alarm_of) -> None:
    """Section 1: an axis that has turned freely needs G28 before its words mean anything; G81 needs it,
    too."""
    head = "G81 T20 L1\nS300\nG04 X1.\nG80\n"
    assert alarm_of(f"{head}G81 T20 L1\nM30") == "HT9008"
    assert alarm_of(f"{head}G00 Y0\nM30") == "PS0197"
    result = run(f"{head}G28 V0\nG81 T20 L1\nG80\nG00 Y12.\nM30")
    assert result.alarms == ()
    assert result.machine["Y"] == result.absolute["Y"] == 12.0


def test_repeated_g81_by_ecn(run) -> None:
    """201#4 = 1 takes the new T L; ΔZ restarts, compensation so far stays; without Q P the gear is spur
    from there."""
    result = run(
        "G81 T20 L1 Q2. P20.\nG01 Z-10. F1000\nG81 T20 L1 Q2. P-20.\nG01 Z-25.\nG81 T40 L1\nZ-40.\nG80\nM30",
        parameters=ECN,
    )
    rate = 360 * math.sin(math.radians(20)) / (math.pi * 20 * 2)
    assert result.alarms == ()
    assert result.machine["C"] == pytest.approx((10 * rate - 15 * rate) % 360, abs=1e-6)


def test_ratio_change_while_turning_jumps_and_warns(run, drive) -> None:
    """With T, L changed while turning the twin shows the real velocity jump and warns, naming it in rpm."""
    program = "G81 T20 L1\nS600\nG04 X2.\nG81 T10 L1\nG04 X1.\nS0\nG80\nM30"
    result = run(program, parameters=ECN)
    (warning,) = result.warnings
    assert (warning.number, warning.found) == ("HT9100", "a jump of +30.000 rpm")
    work = drive(program, parameters=ECN).axis("C")
    steps = np.diff(work)
    assert np.abs(np.diff(work)).max() == pytest.approx(0.36, rel=1e-9)
    assert np.diff(steps).max() == pytest.approx(0.18, rel=1e-6)


def test_same_ratio_again_does_not_warn(run) -> None:
    assert run("G81 T20 L1\nS600\nG04 X2.\nG81 T40 L2\nS0\nG80\nM30", parameters=ECN).warnings == ()


def test_axes_still_turning_out_of_sync(alarm_of) -> None:
    """G81 while one of its axes still turns out of sync: alarm; after M05 it still needs position control
    (PS0197)."""
    assert alarm_of("S100 M03\nG81 T20 L1\nM30") == "HT9008"
    assert alarm_of("S100 M03\nM05\nG81 T20 L1\nM30") == "PS0197"
    assert alarm_of("S100 M03\nM05\nM19\nG81 T20 L1\nG80\nM30") is None


def test_program_ending_in_sync_says_so(run) -> None:
    result = run("G81 T20 L1\nS300\nG04 X1.")
    assert [w.number for w in result.warnings] == ["HT9113"]


def test_overtravel_cancels_sync_a_program_alarm_does_not(drive) -> None:
    """Alarm classes: program alarms leave sync on, overtravel cancels it and the slave brakes."""
    text = "G81 T20 L1\nS300\nG04 X1.\nG01 Z-900. F8000\nM30"
    driven = drive(text)
    assert [a.number for a in driven.controller.alarms] == ["OT0501"]
    assert not driven.sync[-1]
    assert np.diff(driven.axis("C"))[-1] <= 0.5 * 3600.0 * 1e-6 * (1 + 1e-6)  # the last tick of braking
    driven = drive("G81 T20 L1\nS300\nG04 X1.\nG01 Q5\nM30")
    assert [a.number for a in driven.controller.alarms] == ["PS0009"]
    assert driven.sync[-1]


def test_overtravel_in_the_follow_type(drive) -> None:
    """Alarm classes hold for the follow type as well: the slave brakes from what its drive had."""
    driven = drive("G81 T2 L1\nS300\nG04 X1.\nG01 Z-900. F8000\nM30", parameters=FOLLOW)
    assert [a.number for a in driven.controller.alarms] == ["OT0501"]
    work = np.diff(driven.axis("C"))
    assert not driven.sync[-1]
    assert work[-1] <= 3600.0 * 1e-6
    assert np.abs(np.diff(work)).max() <= 3600.0 * 1e-6 * (1 + 1e-6)


def test_the_master_alone_leaves_a_moved_slave_its_limit(run) -> None:
    """No axis beyond its own limit (sections 2 and 4): what helical shift or an increment of the slave adds
    to the sync motion is slowed and reported; nothing is left where the master takes the slave to it."""
    text = "G81 T1 L1 Q1. P80.\nS{}\nG04 X4.\nG01 Z{} F300\nS0\nG80\nM30"
    slowed = run(text.format(1950, -10))
    assert [w.number for w in slowed.warnings] == ["HT9107"]
    assert slowed.peaks["C"].speed == pytest.approx(2000.0, rel=1e-9)
    none_left = run(text.format(2000, -10)).alarms[0]
    assert (none_left.number, none_left.span and none_left.span.line) == ("PS1596", 4)
    other_way = run(text.format(2000, 10))
    assert (other_way.alarms, other_way.warnings) == ((), ())
    jogged = run("G81 T1 L1\nS1950\nG04 X4.\nG00 H100.\nS0\nG80\nM30")
    assert jogged.peaks["C"].speed == pytest.approx(2000.0, rel=1e-9)


@pytest.mark.parametrize(
    ("text", "column"), [("G81 T20 M08", 9), ("G81 T20\nS100 M03", 6), ("G81 T20\nG04 X1. M30", 9)]
)
def test_the_place_of_a_forbidden_m_code(run, text: str, column: int) -> None:
    """Section 1: each alarm carries the place of what was found; here an M code beside or in sync."""
    found = run(text).alarms[0].span
    assert found is not None
    assert (found.line, found.column) == (text.count("\n") + 1, column)


@pytest.mark.parametrize(("setup", "axis", "remedy"), [("hobbing", "Y", "G28 V0"), ("tilted", "B", "G28 B0")])
def test_the_remedy_for_a_hob_that_turned_freely(run, setup: str, axis: str, remedy: str) -> None:
    """G80 while turning: the master keeps S, and is a spindle until its own reference return (PS0197)."""
    found = run(f"G81 T20\nS60\nG80\nG00 {axis}10.\nM30", setup=setup).alarms[0]
    assert (found.number, found.valid) == ("PS0197", f"{remedy} before the block")
