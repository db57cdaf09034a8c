"""Stroke limits as a program meets them: rulings, section 4; inclined axis, 存储行程极限; Fanuc 1300 ff.

Delivered: X in diameter, 2000 mm/s² on every slide; 1300#7 = 1 stops on the limit, so that places are exact.
"""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from controller.dry_run import dry_run
from controller.language.source import parse_program
from controller.tables.parameters import delivered

ON = {"8200#0": 1, "1006#3.X": 0}
HOME = "G28 Y0\nG28 X0\n"
BEFORE = {"1300#7": 1}
TAN, SIN, COS = (f(math.radians(30)) for f in (math.tan, math.sin, math.cos))


def stopped(result) -> tuple[str, str]:
    """Number and first words of the only alarm."""
    (alarm,) = result.alarms
    return alarm.number, alarm.found.split(" at ")[0].split(" beyond ")[0].split(" on ")[0]


# Limit 2: G22, G23


AREA = "G22 X40. Z20. I20. K-20.\n"


@pytest.mark.parametrize(
    ("blocks", "out", "number", "machine"),
    [
        (AREA + "G00 X60.", 0, "OT0502", {"X": 20.0}),
        (AREA + "G00 X60.", 1, "OT0502", {"X": 40.0}),  # from outside in is allowed, and out again is not
        (AREA + "G00 X-1.", 1, "OT0503", {"X": 0.0}),  # further out is not
        ("G00 X30.\n" + AREA + "G00 X60.", 1, "OT0502", {"X": 40.0}),
        ("G00 X30.\n" + AREA + "G00 Z-30.", 1, "OT0503", {"Z": -20.0}),
        (AREA + "G00 Z30.\nG00 X60.\nG00 X0\nG00 Z0", 0, None, {"X": 0.0}),  # round it
        (AREA + "G23\nG00 X60.", 0, None, {"X": 60.0}),
        (AREA + "G23\nG22\nG00 X60.", 0, "OT0502", {"X": 20.0}),  # G22 alone: the area as it is
        ("G00 X60.\n" + AREA + "G00 X0", 0, "OT0503", {"X": 40.0}),
    ],
)
def test_g22_forbids_what_1300_bit_0_says(run, blocks, out, number, machine) -> None:
    """OUT 0: the inside of the area, 1: its outside. Limit 2 always acts after the crossing (BFA is for 1
    and 3), so the axis comes to rest a braking distance behind."""
    result = run(f"{blocks}\nM30", parameters={"1300#0": out} | BEFORE)
    assert [alarm.number for alarm in result.alarms] == ([number] if number else [])
    for letter, place in (machine or {}).items():
        if number is None:
            assert result.machine[letter] == place
        else:
            rest = result.machine[letter] - place
            braking = 2 * (200.0**2 / (2 * 2000.0)) if letter == "X" else 250.0**2 / (2 * 2000.0)
            assert 0 <= (rest if number == "OT0502" else -rest) <= braking + 1e-9


def test_g22_on_the_inclined_axis(run, alarm_of) -> None:
    """Y and J where Y is linear; its area from 60 to 70 is entered at slide Y60, or with AO2 at Cartesian."""
    text = f"{HOME}G22 Y70. J60.\nG01 Y65. F60\nM30"
    for ao2, y in ((0, 60.0 * COS), (1, 60.0)):
        result = run(text, "tilted", ON | {"8201#1": ao2})
        assert result.alarms[0].number == "OT0502"
        assert result.absolute["Y"] == pytest.approx(y, abs=1e-3)
    assert alarm_of("G22 Y70. J60.\nM30") == "PS0009"  # a rotary Y has no area


def test_limit_2_from_the_parameters(run) -> None:
    """1322, 1323 hold until G22 gives another area; off at power-on (G23)."""
    area = {"1322.Z": 40.0, "1323.Z": 20.0}
    assert run("G00 Z60.\nM30", parameters=area).alarms == ()
    assert stopped(run("G22\nG00 Z60.\nM30", parameters=area)) == ("OT0502", "slide Z")
    assert run("G22\nG00 Z60.\nM30", parameters=area | {"1310#0.Z": 0}).alarms == ()


def test_inside_a_forbidden_area_only_the_way_out_is_open(run) -> None:
    inside = "G00 X30. Z18.\n" + AREA
    assert run(inside + "G00 Z30.\nM30").alarms == ()
    assert stopped(run(inside + "G00 Z0.\nM30")) == ("OT0503", "slide Z")


# Limit 3


@pytest.mark.parametrize("bfa", [0, 1])
def test_limit_3_forbids_its_inside_and_obeys_bfa(run, bfa: int) -> None:
    """At F1200 = 20 mm/s and 2000 mm/s² the axis covers 20²/4000 = 0.1 mm while it brakes."""
    area = {"1324.Z": -20.0, "1325.Z": -40.0, "1300#7": bfa}
    result = run("G01 Z-60. F1200\nM30", parameters=area)
    assert stopped(result) == ("OT0505", "slide Z")
    assert result.machine["Z"] == pytest.approx(-20.0 if bfa else -20.1, abs=1e-6)
    assert run("G01 Z-60. F1200\nM30", parameters=area | {"1310#1.Z": 0}).alarms == ()


def test_limit_3_is_a_box_of_all_its_axes(run) -> None:
    box = {"1324.Z": -20.0, "1325.Z": -40.0, "1324.X": 50.0, "1325.X": 30.0} | BEFORE
    assert run("G01 Z-60. F1200\nG00 X40.\nG00 Z-50.\nM30", parameters=box).alarms == ()
    result = run("G00 Z-30.\nG01 X60. F600\nM30", parameters=box)
    assert stopped(result) == ("OT0504", "slide X")
    assert result.machine["X"] == pytest.approx(30.0)


# Arcs


def test_an_arc_stops_where_the_circle_meets_the_limit(run) -> None:
    """Half a circle of radius 10 about Z−10, G03 from Z towards X: X reaches a radius of 8 where
    (Z + 10)² = 100 − 64, at Z−4. G02 bulges to the other side."""
    met = run("G03 Z-20. R10. F600\nM30", parameters={"1320.X": 16.0} | BEFORE)
    assert stopped(met) == ("OT0500", "slide X")
    assert (met.machine["X"], met.machine["Z"]) == pytest.approx((16.0, -4.0), abs=1e-6)
    free = run("G02 Z-20. R10. F600\nM30", parameters={"1320.X": 16.0} | BEFORE)
    assert free.alarms == ()
    assert free.extents["X"].machine == pytest.approx((-20.0, 0.0), abs=1e-6)


def test_an_arc_into_a_forbidden_area(run) -> None:
    """The same arc enters the strip Z−8 … Z−12 at Z−8, where X has the radius √(100 − 4)."""
    strip = {"1324.Z": -8.0, "1325.Z": -12.0} | BEFORE
    result = run("G02 Z-20. R10. F600\nM30", parameters=strip)
    assert stopped(result) == ("OT0505", "slide Z")
    assert abs(result.machine["X"]) == pytest.approx(2 * math.sqrt(96.0), abs=1e-6)


def test_an_arc_of_the_inclined_pair_meets_the_limits_of_its_slides(run) -> None:
    """G17: from (0, 0) about (0, 20), programmed Y reaches slide Y = 23.094 = 20 / cos 30° at a quarter."""
    limit = ON | {"1320.Y": 20.0 / COS} | BEFORE
    result = run(f"{HOME}G17 G03 X0 Y40. I0 J20. F600\nM30", "tilted", limit)
    assert stopped(result) == ("OT0500", "slide Y")
    assert (result.absolute["X"], result.absolute["Y"]) == pytest.approx((20.0, 20.0), abs=1e-6)


def test_an_arc_of_the_inclined_pair_meets_the_limit_of_the_slide_it_induces(run) -> None:
    """Slide X = x + y tan 30° with x = 20 sin u, y = 20 − 20 cos u; its limit at 30 by hand: the first root
    of 20 sin u − 11.547 cos u = 18.453, R = 23.094, phase 30°: sin(u − 30°) = 0.79904, u = 83.038°."""
    limit = ON | {"1320.X": 30.0} | BEFORE
    result = run(f"{HOME}G17 G03 X0 Y40. I0 J20. F600\nM30", "tilted", limit)
    u = math.radians(30.0) + math.asin((30.0 - 20.0 * TAN) / (20.0 / COS))
    assert math.degrees(u) == pytest.approx(83.038, abs=1e-3)
    assert stopped(result) == ("OT0500", "slide X")
    assert (result.absolute["X"], result.absolute["Y"]) == pytest.approx(
        (20.0 * math.sin(u), 20.0 - 20.0 * math.cos(u)), abs=1e-6
    )


# On the slides or Cartesian


@pytest.mark.parametrize(("bit", "first"), [("8201#0", 1320), ("8201#1", 1322), ("8201#2", 1324)])
def test_each_limit_has_its_own_bit(run, bit: str, first: int) -> None:
    """AOT, AO2, AO3: Cartesian Y60 is slide Y69.282. Limits 2 and 3 forbid from Y60 to Y70 here."""
    limits = ON | {f"{first}.Y": 60.0} | BEFORE
    if first > 1320:
        limits |= {f"{first}.Y": 70.0, f"{first + 1}.Y": 60.0}
    text = f"{HOME}G22\nG01 Y65. F60\nM30"
    slides, cartesian = run(text, "tilted", limits), run(text, "tilted", limits | {bit: 1})
    assert stopped(slides)[1] == "slide Y"
    assert stopped(cartesian)[1] == "Cartesian Y"
    assert slides.absolute["Y"] == pytest.approx(60.0 * COS, abs=1e-3)
    assert cartesian.absolute["Y"] == pytest.approx(60.0, abs=1e-3)


def test_the_cartesian_limit_of_the_orthogonal_axis_is_not_touched_by_its_slide(run) -> None:
    limits = ON | {"1320.X": 30.0} | BEFORE
    text = f"{HOME}G01 Y100. F1000\nG01 X30. F1000\nM30"
    assert run(text, "tilted", limits | {"8201#0": 1}).alarms == ()
    assert stopped(run(text, "tilted", limits)) == ("OT0500", "slide X")


def test_a_cartesian_limit_tells_where_the_axis_stands_in_its_own_coordinates(run) -> None:
    """A message names what stops and the limit it hits: AOT = 1 measures both figures Cartesian."""
    limits = ON | {"1320.X": 50.0, "8201#0": 1}
    (alarm,) = run(f"{HOME}G00 Y60.\nG00 X51.\nM30", "tilted", limits).alarms
    assert alarm.found == "Cartesian X at its limit 50.000 mm, standing at 51.000 mm"


# Check before motion


@pytest.mark.parametrize(
    ("parameters", "number"),
    [
        ({"8201#0": 1, "1301#7": 1}, "OT0510"),
        ({"8201#0": 0, "1301#7": 1}, "OT0500"),  # slant coordinates: it does not act, the limit does
        ({"8201#0": 1, "1301#7": 0}, "OT0500"),
    ],
)
def test_check_before_motion(run, parameters: dict[str, float], number: str) -> None:
    """移动前行程检测 acts only where the limit is set Cartesian; such a block does not begin."""
    limits = ON | {"1320.Y": 50.0} | BEFORE | parameters
    result = run(f"{HOME}G01 Y10. F600\nG01 Y80.\nM30", "tilted", limits)
    assert stopped(result)[0] == number
    assert (result.absolute["Y"] == 10.0) is (number == "OT0510")
    assert result.alarms[0].span.line == 4


def test_check_before_motion_without_an_inclined_pair(run) -> None:
    result = run("G01 Z-10. F600\nG01 Z-80.\nM30", parameters={"1301#7": 1, "1321.Z": -50.0})
    assert stopped(result) == ("OT0511", "slide Z")
    assert result.machine["Z"] == -10.0


# Limit switches


@pytest.mark.parametrize(
    ("signal", "blocks", "number"),
    [
        ("*+LZ", "G00 Z1.", "OT0506"),
        ("*+LZ", "G00 Z-1.", None),
        ("*-LZ", "G00 Z-1.", "OT0507"),
        ("*-LZ", "G00 X1.", None),
    ],
)
def test_limit_switches(run, signal: str, blocks: str, number: str | None) -> None:
    """*+Lx, *−Lx = 0: the slide may only go back."""
    result = run(f"{blocks}\nM30", signals={signal: False})
    assert [alarm.number for alarm in result.alarms] == ([number] if number else [])
    if number:
        assert signal in result.alarms[0].found
        assert result.machine["Z"] == 0.0


def test_limit_switch_acts_on_the_slide_whatever_commands_it(run) -> None:
    """A slide signal of the orthogonal axis is touched by motion that the inclined axis induces."""
    result = run(f"{HOME}G01 Y10. F600\nM30", "tilted", ON, signals={"*+LX": False})
    assert stopped(result) == ("OT0506", "slide X")
    alone = run(f"{HOME}G53 Y10.\nM30", "tilted", ON, signals={"*+LX": False})
    assert alone.alarms == ()


# The alarm class


def test_overtravel_cancels_sync_and_names_its_place(run) -> None:
    """All classes but program and user cancel it (hobbing, 注意事项)."""
    result = run("G81 T20 L1\nS60\nG01 Z-60. F1200\nM30", parameters={"1321.Z": -5.0} | BEFORE)
    (alarm,) = result.alarms
    assert (alarm.kind.value, alarm.span.line, alarm.span.column) == ("overtravel", 3, 5)
    assert result.absolute["C"] != 0.0  # released: the absolute has taken the sync motion


@pytest.mark.parametrize(
    ("text", "setup", "parameters"),
    [
        ("G01 Z-60. F1200", "hobbing", {"1321.Z": -20.0}),
        ("G01 Z-60. F1200", "hobbing", {"1324.Z": -20.0, "1325.Z": -40.0} | BEFORE),
        ("G03 Z-20. R10. F600", "hobbing", {"1320.X": 16.0} | BEFORE),
        ("G22 X40. Z20. I20. K-20.\nG01 X30. Z5. F900", "hobbing", {}),
        (f"{HOME}G17 G03 X0 Y40. I0 J20. F600", "tilted", ON | {"1320.X": 30.0}),
    ],
)
@pytest.mark.parametrize("limit", [4096, 7])
def test_a_run_stops_where_check_says(run, drive, text: str, setup: str, parameters, limit: int) -> None:
    """`hobtwin check` predicts both kinds: the sampled motion ends at the alarm's own place."""
    said = run(f"{text}\nM30", setup, parameters)
    driven = drive(f"{text}\nM30", setup, parameters=parameters, limit=limit)
    assert [a.number for a in driven.controller.alarms] == [a.number for a in said.alarms]
    assert said.alarms[0].kind.value == "overtravel"
    for letter in "XZ":
        factor = 2.0 if letter == "X" and parameters.get("1006#3.X", 1) else 1.0
        assert driven.axis(letter)[-1] * factor == pytest.approx(said.machine[letter], abs=1e-6)


def test_braking_for_one_limit_does_not_cross_another_that_acts_before(run) -> None:
    """Limit 2 at Z50 brakes behind it (250 mm/s at rapid need 15.6 mm), limit 1 at Z60 is never crossed."""
    area = {"1322.Z": 50.0, "1323.Z": -50.0, "1300#0": 1, "1320.Z": 60.0} | BEFORE
    result = run("G22\nG00 Z100.\nM30", parameters=area)
    assert stopped(result) == ("OT0502", "slide Z")
    assert result.machine["Z"] == pytest.approx(60.0)
    alone = run("G22\nG00 Z100.\nM30", parameters=area | {"1320.Z": 400.0})
    assert alone.machine["Z"] == pytest.approx(50.0 + 250.0**2 / 4000.0)


place = st.integers(-300, 300).map(float)
block = st.tuples(
    st.sampled_from(["G00", "G01 F3000", "G28", "G53"]),
    st.lists(st.tuples(st.sampled_from("XZY"), place), min_size=1),
)


@settings(max_examples=60, deadline=None)
@given(st.lists(block, min_size=1, max_size=6), st.booleans(), st.sampled_from([-30.0, 40.0]))
def test_nothing_ever_goes_beyond_a_limit_that_acts_before(blocks, cartesian: bool, angle: float) -> None:
    """1300#7 = 1: whatever the program asks for, no slide (AOT = 0), or no Cartesian position (AOT = 1),
    leaves limit 1, and no position on the way is beyond it."""
    bounds = {"X": (-90.0, 130.0), "Z": (-60.0, 60.0), "Y": (-70.0, 70.0)}
    parameters = ON | BEFORE | {"8201#0": cartesian, "8210": angle}
    for letter, (low, high) in bounds.items():
        parameters |= {f"1321.{letter}": low, f"1320.{letter}": high}
    lines = [f"{code} " + " ".join(f"{k}{v}" for k, v in dict(words).items()) for code, words in blocks]
    program = parse_program("\n".join(["G28 Y0", "G28 X0", *lines, "M30"]))
    result = dry_run(program, delivered("tilted", parameters))
    for letter, (low, high) in bounds.items():
        extent = result.extents[letter]
        smallest, largest = extent.absolute if cartesian else extent.machine
        assert low - 1e-6 <= smallest <= largest <= high + 1e-6
