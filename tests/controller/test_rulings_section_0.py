"""Rulings, section 0, sentence by sentence: the lathe, its two set-ups, its senses, as delivered."""

import math

import pytest

from controller.language.offsets import Offsets
from controller.tables.codes import POWER_ON, g_name
from controller.tables.machine_data import machine_data
from controller.tables.parameter_table import PARAMETERS
from controller.tables.parameters import delivered

INCLINED = {"8200#0": 1}


@pytest.mark.parametrize(
    ("setup", "letters", "rotary", "numbers"),
    [
        ("hobbing", "XZYC", "YC", {197: 3, 198: 4, 199: 2}),
        ("tilted", "XZYCB", "CB", {197: 5, 198: 4, 199: 2, 8211: 3, 8212: 1, 8210: -30000}),
    ],
)
def test_the_two_set_ups(setup: str, letters: str, rotary: str, numbers: dict[int, float]) -> None:
    """The table: axes in system order, tool and work spindle rotary, the parameters that name them."""
    parameters = delivered(setup)
    machine = machine_data(parameters)
    assert "".join(machine.letters) == letters
    assert "".join(axis.letter for axis in machine.axes if axis.rotary) == rotary
    assert all(axis.type_a for axis in machine.axes if axis.rotary)
    assert {number: parameters.number(number) for number in numbers} == numbers
    assert (machine.axes[machine.work_spindle].letter, machine.axes[machine.tool_spindle].letter) == (
        ("C", "Y") if setup == "hobbing" else ("C", "B")
    )


@pytest.mark.parametrize("setup", ["hobbing", "tilted"])
def test_all_bits_of_the_functions_are_0_as_delivered(setup: str) -> None:
    """8200 = 0, 8201 = 0, 8209 = 0, 201 = 0 on both set-ups."""
    assert {delivered(setup).number(number) for number in (8200, 8201, 8209, 201)} == {0}


# Machine data are parameters, not code


def test_letters_are_parameter_1020(run, alarm_of) -> None:
    """Axis letters are machine data: the tool spindle as A takes A words, and Y is no address then."""
    named = {"1020.Y": "A"}
    assert run("G00 A90.\nM30", parameters=named).machine["A"] == 90.0
    assert alarm_of("G00 Y90.\nM30", parameters=named) == "PS0009"


def test_diameter_is_parameter_1006_bit_3(run) -> None:
    for diameter, travel in ((1, 10.0), (0, 10.0)):
        result = run("G01 X10. F600\nM30", parameters={"1006#3.X": diameter})
        assert (result.absolute["X"], result.machine["X"]) == (travel, travel)
    in_diameter, in_radius = (
        run("G01 X10. F600\nM30", parameters={"1006#3.X": bit}).cycle_time_s for bit in (1, 0)
    )
    assert in_radius - in_diameter == pytest.approx(0.5, abs=1e-6)  # 5 mm more of slide travel at 10 mm/s


def test_type_a_is_parameter_1006_bit_1(run) -> None:
    """A rotary axis of type A counts modulo 360° and goes the short way; type B does neither."""
    a, b = (run("G00 C350.\nM30", parameters={"1006#1.C": bit}) for bit in (0, 1))
    assert (a.turns["C"], b.turns["C"]) == (pytest.approx(-10 / 360), pytest.approx(350 / 360))
    a, b = (run("G00 H400.\nM30", parameters={"1006#1.C": bit}).absolute["C"] for bit in (0, 1))
    assert (a, b) == (40.0, 400.0)


def test_rapid_speed_and_acceleration_are_parameters(run) -> None:
    """1420 and 1660: 100 mm at 6000 mm/min and 1000 mm/s² take 1.0 + 0.1 s (trapezium)."""
    fast = {"1420.Z": 6000, "1660.Z": 1000}
    assert run("G00 Z100.\nM30", parameters=fast).cycle_time_s == pytest.approx(1.1)


def test_reference_points_are_parameter_1240_in_mm(run) -> None:
    """Of an axis in diameter, too: X is counted as its machine display counts."""
    result = run("G28 U0 W0\nM30", parameters={"1240.X": 20.0, "1240.Z": -30.0})
    assert (result.machine["X"], result.machine["Z"]) == (20.0, -30.0)


@pytest.mark.parametrize(
    ("key", "word", "number"), [("1320.Z", "250.5", "OT0500"), ("1321.Z", "-9", "OT0501")]
)
def test_stroke_limits_are_parameters_in_mm(run, key: str, word: str, number: str) -> None:
    result = run(f"G00 Z{word}\nG00 Z{float(word) * 1.01}\nM30", parameters={key: float(word), "1300#7": 1})
    assert [alarm.number for alarm in result.alarms] == [number]
    assert result.machine["Z"] == pytest.approx(float(word))


@pytest.mark.parametrize(("value", "degrees"), [("-30000", -30.0), ("-30.", -30.0), ("15250", 15.25)])
def test_8210_counts_thousandths_and_with_a_point_degrees(run, value: str, degrees: float) -> None:
    result = run("G28 Y0\nG28 X0\nG00 Y100.\nM30", "tilted", INCLINED | {"8210": value})
    assert result.machine["Y"] == pytest.approx(100.0 / math.cos(math.radians(degrees)), abs=1e-6)


def test_increment_isb(run) -> None:
    """Least increment 0.001 mm and 0.001°; ISC is left out."""
    result = run("G00 Z1.2349 C0.0019\nM30")
    assert (result.absolute["Z"], result.absolute["C"]) == (1.234, 0.001)


# Senses


@pytest.mark.parametrize(("s", "starts", "sense"), [(300, 1, 1), (300, -1, -1), (-300, 1, -1), (-300, -1, 1)])
def test_s_and_l_positive_turn_both_spindles_positively(run, s: int, starts: int, sense: int) -> None:
    """S > 0, L > 0 with a right-hand hob: C+, in axis coordinates."""
    result = run(f"G81 T20 L{starts}\nS{s}\nG04 X1.\nS0\nG80\nM30")
    assert math.copysign(1, result.turns["Y"]) == math.copysign(1, s)
    assert math.copysign(1, result.turns["C"]) == sense


def test_a_right_hand_gear_needs_c_against_z(run) -> None:
    """k = −1: ΔC < 0 for ΔZ > 0; by hand: 360° · 10 · sin 20° / (π · 20 · 2) = 9.7983°."""
    result = run("G81 T20 L1 Q2. P20.\nG01 W10. F600\nM30")
    assert result.turns["C"] * 360 == pytest.approx(-9.7983, abs=1e-3)
    other = run("G81 T20 L1 Q2. P20.\nG01 W10. F600\nM30", parameters={"9003": 1})
    assert other.turns["C"] == pytest.approx(-result.turns["C"])


# References, offsets, speeds, limits as delivered


@pytest.mark.parametrize("setup", ["hobbing", "tilted"])
def test_power_on_position_is_machine_zero(run, setup: str) -> None:
    """Power-on position: machine zero, rotary axes 0; reference points lie at machine zero."""
    result = run("M30", setup)
    home = run("G28 U0 W0\nG28 H0\nM30", setup)
    for one in (result, home):
        assert set(one.machine.values()) == set(one.absolute.values()) == {0.0}


@pytest.mark.parametrize(
    ("setup", "word"),
    [
        ("hobbing", "X600."),
        ("hobbing", "Z300."),
        ("tilted", "X600."),
        ("tilted", "Z300."),
        ("tilted", "Y300."),
    ],
)
def test_delivered_limits_leave_300_mm_on_every_linear_axis(run, setup: str, word: str) -> None:
    """±300 mm of slide travel about the reference point, which is 600 of X in diameter."""
    back = f"{word[0]}-{word[1:]}"
    result = run(f"G00 {word}\nG00 {back}\nM30", setup)
    assert result.alarms == ()
    assert result.extents[word[0]].machine == (float(back[1:]), float(word[1:]))


def test_without_a_job_absolute_is_machine(run) -> None:
    """All offsets zero; the inclined axis apart."""
    for setup in ("hobbing", "tilted"):
        result = run("G00 X50. Z-20. C30.\nT0101\nG55 G01 Z-25. F500\nM30", setup)
        assert result.absolute == result.machine


def test_with_a_job_machine_zero_lies_at_x_400_z_300(run) -> None:
    """The presets that the twin makes of `reference`: G54 with −400 (diameter) and −300."""
    offsets = Offsets(work={"G54": {"X": -400.0, "Z": -300.0}})
    result = run("M30", offsets=offsets)
    assert (result.absolute["X"], result.absolute["Z"]) == (400.0, 300.0)
    there = run("G00 X35. Z0.\nM30", offsets=offsets)
    assert (there.machine["X"], there.machine["Z"]) == (-365.0, -300.0)


def test_the_mounted_tool_needs_no_t_word(run) -> None:
    """A single tool is mounted without a T word; its offset holds until the first T."""
    offsets = Offsets(mounted={"X": 10.0}, tool={2: {"X": 4.0}})
    assert run("M30", offsets=offsets).absolute["X"] == -10.0
    assert run("T0202\nM30", offsets=offsets).absolute["X"] == -4.0


@pytest.mark.parametrize(
    ("setup", "text", "number"),
    [
        ("hobbing", "G81 T20 L1\nS4000\nS0\nG80\nM30", None),
        ("hobbing", "M03 S2000\nM05\nM30", None),
        ("tilted", "G81 T20 L1\nS4000\nS0\nG80\nM30", None),
        ("hobbing", "M03 S2001\nM30", "PS1544"),
        ("hobbing", "G81 T20 L1\nS4001\nM30", "PS1544"),
    ],
)
def test_speeds_as_delivered(alarm_of, setup: str, text: str, number: str | None) -> None:
    """Tool spindle up to 4000 rpm or more, work spindle 2000 or more (parameter 3772)."""
    assert alarm_of(text, setup) == number


# Power-on modal state: G00 G97 G98 G18 G21 G23 G40 G54 G64 G67 G80 G50.2


def test_power_on_table() -> None:
    stated = ["G00", "G97", "G98", "G18", "G21", "G23", "G40", "G54", "G64", "G67", "G80", "G50.2"]
    assert set(stated) <= {g_name(code) for code in POWER_ON.values()}


def test_g00_holds_at_power_on(run) -> None:
    bare, rapid = run("Z100.\nM30"), run("G00 Z100.\nM30")
    assert bare.alarms == ()
    assert bare.cycle_time_s == rapid.cycle_time_s


def test_g97_holds_at_power_on(run) -> None:
    """S is rpm: 60 rpm for 10 s are 10 turns and what the ramps turn."""
    plain, stated = (run(f"{code}M03 S60\nG04 X10.\nM05\nM30") for code in ("", "G97 "))
    assert plain.turns["C"] == stated.turns["C"]
    assert plain.turns["C"] == pytest.approx(10.0, abs=0.1)


def test_g98_and_g21_hold_at_power_on(run) -> None:
    """F is mm/min and a length is mm: 100 mm at F600 take 10 s and a ramp."""
    result = run("G01 Z100. F600\nM30")
    assert result.machine["Z"] == 100.0
    assert result.cycle_time_s == pytest.approx(10.0, abs=0.02)


def test_g54_holds_at_power_on(run) -> None:
    offsets = Offsets(work={"G54": {"Z": 5.0}, "G55": {"Z": 7.0}})
    assert run("G00 Z0.\nM30", offsets=offsets).machine["Z"] == 5.0
    assert run("G55 G00 Z0.\nM30", offsets=offsets).machine["Z"] == 7.0


def test_neither_gear_box_is_engaged_at_power_on(run) -> None:
    """G80, G50.2: a move of a spindle axis is free, and both codes may stand there once more."""
    assert run("G80\nG50.2\nG00 C10. Y20.\nM30").machine == {"X": 0.0, "Z": 0.0, "Y": 20.0, "C": 10.0}


# References at program start


def test_references_at_start(alarm_of) -> None:
    """On an inclined pair with 8200#0 = 1 not established; all other axes established; else PS0224."""
    for axis in "XY":
        assert alarm_of(f"G00 {axis}1.\nM30", "tilted", INCLINED) == "PS0224"
        assert alarm_of(f"G00 {axis}1.\nM30", "tilted") is None
    for axis in "ZCB":
        assert alarm_of(f"G00 {axis}1.\nM30", "tilted", INCLINED) is None


# The table of parameters


def test_every_parameter_has_meaning_clause_range_and_a_delivered_value() -> None:
    for number, entry in PARAMETERS.items():
        assert entry.meaning
        assert entry.clause
        assert entry.low <= entry.high
        for setup in ("hobbing", "tilted"):
            values = delivered(setup)
            for letter in values.letters if entry.per_axis else ("",):
                value = values.number(number, letter)
                top = 255 if entry.bits else entry.high
                assert (0 if entry.bits else entry.low) <= value <= top
