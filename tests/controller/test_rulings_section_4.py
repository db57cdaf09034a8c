"""Rulings, section 4, sentence by sentence: the inclined axis, as a user of the delivered machine meets it.

θ = −30°, Y inclined, X orthogonal. Hand-worked: 100 · tan 30° = 57.735, 100 / cos 30° = 115.470.
"""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from controller.dry_run import dry_run
from controller.language.source import parse_program
from controller.laws.inclined import Frame
from controller.tables.alarms import ControllerError
from controller.tables.machine_data import machine_data
from controller.tables.parameters import delivered
from controller.tables.signals import SIGNALS

ON = {"8200#0": 1}
IN_RADIUS = ON | {"1006#3.X": 0}
HOME = "G28 Y0\nG28 X0\n"
TAN, COS = math.tan(math.radians(30)), math.cos(math.radians(30))


def xy(values) -> tuple[float, float]:
    return values["X"], values["Y"]


# The law

TABLE = [
    # from the table of worked cases: blocks, ARF, NOZAGC, absolute, machine, with C = 1
    ("G00 Y100.", 0, 0, (0, 100), (57.735, 115.470)),
    ("G00 Y100.\nG00 X200.", 0, 0, (200, 100), (257.735, 115.470)),
    ("G00 Y100.", 0, 1, (0, 100), (0, 115.470)),
    ("G00 Y100.\nG00 X200.", 0, 1, (200, 100), (200, 115.470)),
    ("G53 Y100.", 0, 0, (-50, 86.603), (0, 100)),
    ("G53 Y100.\nG53 X200.", 0, 0, (150, 86.603), (200, 100)),
    ("G00 X200. Y100.\nG28 X200.", 1, 0, (0, 100), (57.735, 115.470)),
    ("G00 X200. Y100.\nG28 X200.", 0, 0, (-57.735, 100), (0, 115.470)),
    ("G00 X200. Y100.\nG28 X200.\nG28 Y100.", 1, 0, (0, 0), (0, 0)),
    ("G00 X200. Y100.\nG28 X200.\nG28 Y100.", 0, 0, (0, 0), (0, 0)),
]


def doubled(blocks: str) -> str:
    return blocks.replace("X200.", "X400.")


@pytest.mark.parametrize("case", TABLE)
@pytest.mark.parametrize("diameter", [False, True], ids=["C=1", "C=2"])
@pytest.mark.parametrize("sense", [1, -1], ids=["-30", "+30"])
def test_worked_cases_with_c_1_and_2_and_both_signs(run, case, diameter: bool, sense: int) -> None:
    """The table; as delivered X counts in diameter (C = 2), so every X of it doubles. With θ = +30° the
    shift of X by Y turns its sign: the case X → −X is the same one mirrored."""
    blocks, arf, nozagc, absolute, machine = case
    text = doubled(blocks) if diameter else blocks
    factor = (2 if diameter else 1) * sense
    if sense < 0:
        text = text.replace("X", "X-")
    parameters = (ON if diameter else IN_RADIUS) | {"8209#0": arf, "8210": -30000 * sense}
    result = run(f"{HOME}{text}\nM30", "tilted", parameters, signals={"NOZAGC": bool(nozagc)})
    assert result.alarms == ()
    assert xy(result.absolute) == pytest.approx((absolute[0] * factor, absolute[1]), abs=1e-3)
    assert xy(result.machine) == pytest.approx((machine[0] * factor, machine[1]), abs=1e-3)


@pytest.mark.parametrize(
    ("x", "y", "c"), [(0, 0, 1.0), (1, 0, 2.0), (0, 1, 0.5), (1, 1, 1.0)], ids=["rr", "dr", "rd", "dd"]
)
def test_c_is_the_ratio_of_the_diameter_factors(run, x: int, y: int, c: float) -> None:
    """Ya = Yp / cos θ, Xa = Xp − C · Yp · tan θ, in programmed units of each axis."""
    parameters = ON | {"1006#3.X": x, "1006#3.Y": y}
    result = run(f"{HOME}G01 X10. Y60. F1000\nM30", "tilted", parameters)
    assert xy(result.machine) == pytest.approx((10 + c * 60 * TAN, 60 / COS), abs=1e-3)
    assert xy(result.absolute) == (10.0, 60.0)


def test_displays(run) -> None:
    """Absolute and relative displays are Cartesian, machine is the slides'."""
    result = run(f"{HOME}G01 X10. Y60. F1000\nM30", "tilted", IN_RADIUS)
    assert xy(result.absolute) == xy(result.relative) == (10.0, 60.0)
    assert xy(result.machine) == pytest.approx((10 + 60 * TAN, 60 / COS), abs=1e-3)


number = st.integers(-100, 100).map(lambda k: k / 2)
word = st.tuples(st.sampled_from("XYUV"), number)
block = st.one_of(
    st.tuples(st.sampled_from(["G00", "G01", "G28"]), st.lists(word, min_size=1, max_size=2)),
    st.tuples(st.just("G53"), st.lists(st.tuples(st.sampled_from("XY"), number), min_size=1, max_size=2)),
)


@settings(max_examples=60, deadline=None)
@given(st.lists(block, max_size=6), st.floats(-60, 60), st.booleans(), st.booleans())
def test_displays_obey_the_law_after_any_program(blocks, angle, arf, diameter) -> None:
    """Without NOZAGC the machine is the law's image of the absolute, whatever way the axes have come:
    Cartesian moves, slides alone by G53, returns by ARF 0 or 1."""
    lines = []
    for code, words in blocks:
        named = {"XU".find(letter) >= 0: f"{letter}{value:.1f}" for letter, value in words}
        lines.append(f"{code} {' '.join(named.values())} F3000")
    parameters = {"8200#0": 1, "8210": f"{angle:.3f}", "8209#0": arf, "1006#3.X": diameter}
    program = parse_program("\n".join(["G28 Y0", "G28 X0", *lines, "M30"]))
    result = dry_run(program, delivered("tilted", parameters))
    theta, c = math.radians(float(f"{angle:.3f}")), 2.0 if diameter else 1.0
    assert [alarm for alarm in result.alarms if not alarm.number.startswith("OT")] == []
    x, y = xy(result.absolute)
    law = (x - c * y * math.tan(theta), y / math.cos(theta))
    assert xy(result.machine) == pytest.approx(law, abs=1e-5)
    low, high = result.extents["Y"].machine
    assert low - 1e-6 <= result.machine["Y"] <= high + 1e-6


# Speeds


def test_speed_by_component(drive) -> None:
    """Fay = Fpy / cos θ, Fax = Fpx − C · Fpy · tan θ. Pure Y at 100 mm/min: X runs at 57.7, not 157.7."""
    driven = drive(f"{HOME}G01 Y10. F100\nM30", "tilted", parameters=IN_RADIUS)
    x, y = (np.abs(np.diff(driven.axis(letter))).max() * 60_000 for letter in "XY")
    assert (x, y) == (pytest.approx(100 * TAN, abs=1e-3), pytest.approx(100 / COS, abs=1e-3))


def test_speed_of_both_components(drive) -> None:
    """Along (3, 4) at 100: Fpx = 60, Fpy = 80, so Fax = 60 + 80 tan 30° and Fay = 80 / cos 30°."""
    driven = drive(f"{HOME}G01 X3. Y4. F100\nM30", "tilted", parameters=IN_RADIUS)
    x, y = (np.abs(np.diff(driven.axis(letter))).max() * 60_000 for letter in "XY")
    assert (x, y) == (pytest.approx(60 + 80 * TAN, abs=1e-3), pytest.approx(80 / COS, abs=1e-3))


@pytest.mark.parametrize("code", ["G01", "G00"])
def test_an_axis_beyond_its_limit_is_slowed_and_the_path_kept(drive, code: str) -> None:
    """Slowed, path kept; a feed is reported. With X at most 300 mm/min, Y may do 300 / tan 30° / … ."""
    slow = IN_RADIUS | {"1430.X": 300, "1420.X": 300}
    driven = drive(f"{HOME}{code} Y10. F1000\nM30", "tilted", parameters=slow)
    x, y = driven.axis("X"), driven.axis("Y")
    assert np.abs(np.diff(x)).max() * 60_000 == pytest.approx(300.0, abs=1e-3)
    assert np.abs(x - y * math.sin(math.radians(30))).max() < 1e-9  # Cartesian X stays 0
    warnings = [warning.number for warning in driven.controller.warnings]
    assert warnings == (["HT9107"] if code == "G01" else [])


# G28 and ARF


def test_intermediate_point_is_cartesian_and_obeys_nozagc(run) -> None:
    """The move to the intermediate point is an ordinary Cartesian move: G28 Y100. from the origin takes X
    along by 57.735, and with NOZAGC = 1 not."""
    both = run(f"{HOME}G28 Y100.\nM30", "tilted", IN_RADIUS)
    alone = run(f"{HOME}G28 Y100.\nM30", "tilted", IN_RADIUS, signals={"NOZAGC": True})
    assert both.extents["X"].machine == pytest.approx((0.0, 57.735), abs=1e-3)
    assert alone.extents["X"].machine == (0.0, 0.0)


@pytest.mark.parametrize(("arf", "machine_x", "absolute_x"), [(0, 57.735, 57.735), (1, 0.0, 0.0)])
def test_arf_on_the_way_of_the_inclined_axis(run, arf: int, machine_x: float, absolute_x: float) -> None:
    """8209#0: 0 = that slide alone moves from the intermediate point, 1 = Cartesian. From Y100 X0 the slide
    of X stands at 57.735; alone it stays there, and X reads what the slide then is."""
    result = run(f"{HOME}G28 Y100.\nM30", "tilted", IN_RADIUS | {"8209#0": arf})
    assert xy(result.machine) == pytest.approx((machine_x, 0.0), abs=1e-3)
    assert xy(result.absolute) == pytest.approx((absolute_x, 0.0), abs=1e-3)


# NOZAGC


@pytest.mark.parametrize("nozagc", [False, True])
def test_g53_of_the_inclined_axis_never_moves_the_orthogonal_one(run, nozagc: bool) -> None:
    result = run(f"{HOME}G53 Y100.\nM30", "tilted", IN_RADIUS, signals={"NOZAGC": nozagc})
    assert result.extents["X"].machine == (0.0, 0.0)
    assert xy(result.absolute) == pytest.approx((-50.0, 86.603), abs=1e-3)


@pytest.mark.parametrize("name", ["NOGAGC", "NOZOGC"])
def test_misprinted_names_of_nozagc_are_the_signal(run, name: str) -> None:
    result = run(f"{HOME}G00 Y100.\nM30", "tilted", IN_RADIUS, signals={name: True})
    assert xy(result.machine) == pytest.approx((0.0, 115.470), abs=1e-3)
    assert "HT9124" in [warning.number for warning in result.warnings]


def test_motion_with_nozagc_loses_the_references(run) -> None:
    """Warning; the order rule applies again; absolute and machine stay offset by the uncompensated amount
    until then."""
    on = {"NOZAGC": True}
    moved = run(f"{HOME}G00 Y100.\nG00 Y0\nG00 Y100. X10.\nM30", "tilted", IN_RADIUS, signals=on)
    assert [w.number for w in moved.warnings] == ["HT9108"]
    assert xy(moved.absolute) == (10.0, 100.0)
    assert moved.machine["X"] == 10.0  # 57.735 less than the law says
    again = run(f"{HOME}G00 Y100.\nG28 U0\nM30", "tilted", IN_RADIUS, signals=on)
    assert [a.number for a in again.alarms] == ["DS0020"]
    both = run(f"{HOME}G00 Y100.\nG28 U0 V0\nM30", "tilted", IN_RADIUS, signals=on)
    assert [a.number for a in both.alarms] == ["DS0020"]
    home = run(f"{HOME}G00 Y100.\nG28 V0\nG28 U0\nM30", "tilted", IN_RADIUS, signals=on)
    assert home.alarms == ()
    assert xy(home.absolute) == xy(home.machine) == (0.0, 0.0)


def test_motion_of_the_orthogonal_axis_alone_loses_nothing(run) -> None:
    result = run(f"{HOME}G00 X100.\nG28 U0\nM30", "tilted", IN_RADIUS, signals={"NOZAGC": True})
    assert result.alarms == result.warnings == ()


# Order of references


@pytest.mark.parametrize(
    ("blocks", "number"),
    [
        ("G28 U0", "DS0020"),
        ("G28 U0 V0", "DS0020"),
        ("G28 V0\nG28 U0 V0", "DS0020"),
        ("G28 V0\nG28 U0", None),
        ("G28 V0\nG28 W0\nG28 U0", None),
        ("G28 V0\nG28 U0\nG28 U0\nG28 V0\nG28 U0 V0", None),
        ("G28 W0", None),
        ("G00 U1.", "PS0224"),
        ("G53 Y1.", "PS0224"),
    ],
)
def test_order(alarm_of, blocks: str, number: str | None) -> None:
    """Inclined before orthogonal; the other order or both in one block, after power-on, DS0020. Once
    established, in any order."""
    assert alarm_of(f"{blocks}\nM30", "tilted", ON) == number


@pytest.mark.parametrize("inclined", [(1, 2), (2, 1)])
def test_the_hobbing_example_alarms_where_x_and_z_are_the_pair(alarm_of, inclined: tuple[int, int]) -> None:
    """G28 U0 W0: correct, and a test."""
    pair = {"8200#0": 1, "8210": 20000, "8211": inclined[0], "8212": inclined[1]}
    assert alarm_of("N0010 G28 U0 W0\nM30", "hobbing", pair) == "DS0020"
    assert alarm_of("N0010 G28 U0 W0\nM30", "hobbing", pair | {"8200#0": 0}) is None


# Stroke limits


LIMIT = "G01 Y200. F1000\nM30"


@pytest.mark.parametrize(("aot", "frame", "y"), [(0, "slide Y", 110 * COS), (1, "Cartesian Y", 110.0)])
def test_limit_1_on_the_slides_or_cartesian(run, aot: int, frame: str, y: float) -> None:
    """AOT 8201#0; on the slides by default. A message names the slide that stops and the limit it hits."""
    limits = IN_RADIUS | {"8201#0": aot, "1320.Y": 110.0, "1300#7": 1}
    result = run(HOME + LIMIT, "tilted", limits)
    (alarm,) = result.alarms
    assert (alarm.number, alarm.found.startswith(frame)) == ("OT0500", True)
    assert "110.000 mm" in alarm.found
    assert (alarm.span.line, alarm.span.column) == (3, 5)
    assert result.absolute["Y"] == pytest.approx(y, abs=1e-6)


def test_the_slide_that_stops_may_be_the_one_that_is_induced(run) -> None:
    """A pure Y move drives the slide of X: its limit at 50 is met when Y reads 50 / tan 30°."""
    result = run(HOME + LIMIT, "tilted", IN_RADIUS | {"1320.X": 50.0, "1300#7": 1})
    (alarm,) = result.alarms
    assert alarm.found.startswith("slide X")
    assert result.absolute["Y"] == pytest.approx(50 / TAN, abs=1e-6)
    assert run(HOME + LIMIT, "tilted", IN_RADIUS | {"1320.X": 50.0, "8201#0": 1}).alarms == ()


@pytest.mark.parametrize(("bfa", "beyond"), [(1, 0.0), (0, (1000 / 60) ** 2 / (2 * 2000 * COS))])
def test_bfa_limit_1(run, bfa: int, beyond: float) -> None:
    """1300#7: alarm before (1) the limit is crossed, or after (0): then the axis brakes from there. The
    slide of Y is the first at its acceleration of 2000 mm/s²; on its own it covers v²/(2a)."""
    result = run(HOME + LIMIT, "tilted", IN_RADIUS | {"1320.Y": 110.0, "1300#7": bfa})
    assert result.machine["Y"] - 110.0 == pytest.approx(beyond / COS, abs=1e-6)


# Configuration


@pytest.mark.parametrize("magnitude", [85.0, 90.0, 95.0])
@pytest.mark.parametrize("sign", [1, -1])
def test_the_dead_band_switches_the_function_off_with_a_warning(run, magnitude: float, sign: int) -> None:
    """8210: ±(85..95) disables the function (warn): Y moves as it is, and nothing needs its reference."""
    result = run("G00 Y10.\nM30", "tilted", ON | {"8210": sign * magnitude})
    assert [w.number for w in result.warnings] == ["HT9111"]
    assert xy(result.machine) == (0.0, 10.0)


@pytest.mark.parametrize("angle", [84.999, -84.999, 95.001, 180.0, -180.0])
def test_other_angles_are_taken_as_they_are(run, angle: float) -> None:
    """−180..180°: beyond 90° the slide of Y runs the other way."""
    far = {f"{number}.{axis}": sign * 5000 for number, sign in ((1320, 1), (1321, -1)) for axis in "XY"}
    result = run(f"{HOME}G00 Y10.\nM30", "tilted", IN_RADIUS | {"8210": angle} | far)
    theta = math.radians(angle)
    assert result.warnings == ()
    assert xy(result.machine) == pytest.approx((-10 * math.tan(theta), 10 / math.cos(theta)), abs=1e-5)


def test_8211_and_8212_are_looked_at_only_with_8200_bit_0() -> None:
    for wrong in ({"8211": 0}, {"8212": 0}, {"8211": 1}, {"8212": 9}, {"8211": 4}, {"8212": 5}):
        assert machine_data(delivered("tilted", wrong)).pair is None


def test_the_units_of_both_agree_in_inches_too(run) -> None:
    """注意 6: G20 holds for both; X1. Y2. are 25.4 and 50.8 mm, the slides follow in mm."""
    result = run(f"{HOME}G20\nG01 X1. Y2. F10\nM30", "tilted", IN_RADIUS)
    assert xy(result.absolute) == (25.4, 50.8)
    assert xy(result.machine) == pytest.approx((25.4 + 50.8 * TAN, 50.8 / COS), abs=1e-3)


# Forbidden together


def test_polygon_turning_is_forbidden(alarm_of) -> None:
    assert alarm_of(f"{HOME}G51.2 P1 Q2\nM30", "tilted", ON) == "HT9014"
    assert alarm_of("G51.2 P1 Q2\nG50.2\nM30", "tilted") is None


@pytest.mark.parametrize("block", ["G84 Z-10. F1.", "G88 X1. F1.", "G07.1 C10.", "G12.1"])
def test_other_forbidden_partners_are_alarms(alarm_of, block: str) -> None:
    """Rigid tapping and the hypothetical axis: the twin has neither, and says so."""
    assert alarm_of(f"{HOME}{block}\nM30", "tilted", ON) == "HT9003"


@pytest.mark.parametrize("number", ["8304", "8010", "8160", "8180"])
def test_no_parameter_asks_for_a_forbidden_partner(run, number: str) -> None:
    """Feed-axis synchronous, PMC axis, two-path and superimposed control: unknown here, never ignored."""
    with pytest.raises(ControllerError, match=f"unknown parameter {number}"):
        run("M30", "tilted", ON | {number: 1})


def test_hobbing_is_allowed_and_noted(run) -> None:
    result = run(f"{HOME}G81 T20 L1\nG80\nM30", "tilted", ON)
    assert result.alarms == ()
    assert [w.number for w in result.warnings] == ["HT9112"]


@pytest.mark.parametrize(
    ("name", "frame"),
    [
        *(
            (name, Frame.CARTESIAN)
            for name in ("*IT{x}", "+J{x}", "-J{x}", "+MIT1", "+MIT2", "ZP{x}", "ZP2{x}")
        ),
        *((name, Frame.SLIDES) for name in ("*+L{x}", "*DEC{x}", "SVF{x}", "DTCH{x}", "MI{x}", "MLK{x}")),
        *((name, Frame.SLIDES) for name in ("INP{x}", "MMI{x}", "MDTCH{x}", "MV{x}", "PSW01")),
    ],
)
def test_frames_of_signals(name: str, frame: Frame) -> None:
    assert SIGNALS[name].frame is frame
