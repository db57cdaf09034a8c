"""Rulings, section 1: G10, G22, G23, G27, G30, G50, G52, G54-G59, T, G96 with its clamp, inches."""

import pytest

from controller.commands import (
    Move,
    ReferenceCheck,
    ReferenceReturn,
    SelectTool,
    SetCoordinates,
    ShiftCoordinates,
    StrokeCheck,
    SurfaceSpeed,
)
from controller.language.offsets import Offsets


def test_work_offsets_by_g10(read) -> None:
    """G10 L2 P1 … P6: the offset in force moves the zero point at once, another one when it is chosen."""
    reading = read("G10 L2 P1 X-100. Z-20.\nG00 X30. Z5.\nG10 L2 P2 Z7.\nG55 G00 Z1.\nG10 L2 P2 W-2.\nM30")
    assert [s.shift for s in reading.of(ShiftCoordinates)] == [
        {0: -50.0, 1: -20.0},
        {0: 50.0, 1: 27.0},
        {1: -2.0},
    ]
    assert (reading.machine["X"], reading.machine["Z"], reading.absolute["Z"]) == (-70.0, 8.0, 3.0)


@pytest.mark.parametrize(
    ("parameters", "machine", "absolute"),
    [
        ({}, (99.0, 52.0), (80.0, 45.0)),
        ({"5002#2": 1}, (100.0, 50.0), (81.0, 43.0)),
        ({"5002#4": 1}, (119.0, 57.0), (100.0, 50.0)),
        ({"5002#6": 1}, (100.0, 50.0), (81.0, 43.0)),
    ],
)
def test_the_move_that_a_tool_offset_causes(read, parameters, machine, absolute) -> None:
    """T with geometry X20 Z5 and wear X-1 Z2 at X100 Z50: 5002 says what the axes follow, by hand.

    Delivered: the geometry moves the zero point, the wear the axes. LWT = 1 nothing moves, LGT = 1 both do,
    LWM = 1 waits for the next words, which then reach X100 + 20 - 1 in any case.
    """
    offsets = Offsets(tool={1: {"X": 20.0, "Z": 5.0}}, wear={1: {"X": -1.0, "Z": 2.0}})
    stops = read("G00 X100. Z50.\nT0101\nM30", offsets=offsets, parameters=parameters)
    assert (stops.machine["X"], stops.machine["Z"]) == pytest.approx(machine, abs=1e-9)
    assert (stops.absolute["X"], stops.absolute["Z"]) == pytest.approx(absolute, abs=1e-9)
    goes_on = read("G00 X100. Z50.\nT0101\nX100. Z50.\nM30", offsets=offsets, parameters=parameters)
    assert (goes_on.machine["X"], goes_on.machine["Z"]) == pytest.approx((119.0, 57.0), abs=1e-9)
    back = read("G00 X100. Z50.\nT0101\nT0100\nM30", offsets=offsets, parameters=parameters)
    assert (back.machine["X"], back.machine["Z"]) == pytest.approx((100.0, 50.0), abs=1e-9)


def test_the_move_of_an_offset_at_feed_needs_one(read) -> None:
    """Under G01 the offset is moved to at the feed in force."""
    offsets = Offsets(wear={1: {"X": -1.0}})
    text = "G98 G01 X100. F600.\nT0101\nM30"
    assert [move.feed.value for move in read(text, offsets=offsets).of(Move)] == [10.0, 10.0]


def test_tool_offsets_by_g10(read) -> None:
    """G10 P1 … P99 sets wear, P10001 … geometry; U W add; it counts from the next T on."""
    offsets = Offsets(tool={1: {"X": 10.0}})
    text = "T0101\nG10 P1 X-1. Z2.\nG10 P1 U.5\nG00 X0 Z0\nT0101\nG00 X0 Z0\nG10 P10001 X4.\nT0101\nX0\nM30"
    reading = read(text, offsets=offsets)
    assert [move.absolute or move.incremental for move in reading.of(Move)] == [
        {0: 0.0, 1: 0.0},
        {0: -0.25, 1: 2.0},
        {0: 0.0, 1: 0.0},
        {0: 0.0},
    ]
    shifts = [s.shift for s in reading.of(ShiftCoordinates)]
    assert shifts == [{0: 5.0}, {0: -0.25, 1: 2.0}, {0: -3.0, 1: 0.0}]
    assert (reading.machine["X"], reading.machine["Z"]) == (4.0 - 1.0 + 0.5, 2.0)
    assert read("G10 P3 R0.8 Q3\n#1=#2203\n#2=#2303\nG00 X#1 Z#2\nM30").stations == [(0.8, 3.0)]


def test_inches_in_offsets(read) -> None:
    """G20: offsets in inches are the same lengths."""
    reading = read("G20 G10 L2 P1 X1. Z-2.\nG10 P1 Z.5\nT0101\nG00 X0 Z0\nM30")
    assert reading.machine["X"] == pytest.approx(25.4)
    assert reading.machine["Z"] == pytest.approx(-50.8 + 12.7)


@pytest.mark.parametrize(
    ("block", "expected"),
    [
        ("G10 X5.", ("PS0030", 1, 1)),
        ("G10 P0 X5.", ("PS0030", 1, 5)),
        ("G10 P100 X5.", ("PS0030", 1, 5)),
        ("G10 P10100 X5.", ("PS0030", 1, 5)),
        ("G10 L2 P0 X5.", ("PS0030", 1, 8)),
        ("G10 L2 P7 X5.", ("PS0030", 1, 8)),
        ("G10 L20 P1 X5.", ("HT9003", 1, 5)),
        ("G10 L50", ("PS0030", 1, 1)),
        ("G10 P1", ("HT9012", 1, 1)),
        ("G10 P1 Q10", ("HT9012", 1, 8)),
        ("G10 L2 P1 R1.", ("HT9012", 1, 1)),
        ("G10 P1 X5. F3.", None),
        ("G10 P1 X5. A3.", ("PS0009", 1, 12)),
        ("G52", ("HT9012", 1, 1)),
        ("G52 U5.", ("PS0009", 1, 5)),
        ("G22 X5.", ("HT9012", 1, 5)),
        ("G22 X5. I6. Z5. K-5.", ("HT9012", 1, 9)),
        ("G27", ("HT9012", 1, 1)),
        ("G30 P1 U0", ("PS0046", 1, 5)),
        ("G30 P2", ("HT9012", 1, 1)),
        ("G11", None),
    ],
)
def test_refused(alarm_in, block: str, expected: tuple[str, int, int] | None) -> None:
    assert alarm_in(f"{block}\nM30") == expected


def test_local_system(read) -> None:
    """G52 X Z: zero of a local system in work coordinates; it replaces the last one, X0 Z0 cancels it."""
    text = "G52 X20. Z-5.\nG00 X0 Z0\nG52 Z-6.\nG00 Z0\nG55\nG52 X0 Z0\nG00 X0 Z0\nM30"
    reading = read(text, offsets=Offsets(work={"G55": {"Z": 3.0}}))
    assert reading.absolute["X"] == 0.0
    assert (reading.machine["X"], reading.machine["Z"]) == (0.0, 3.0)
    positions = [s.shift for s in reading.of(ShiftCoordinates)]
    assert positions == [{0: 10.0, 1: -5.0}, {0: 0.0, 1: -1.0}, {1: 3.0}, {0: -10.0, 1: 6.0}]


def test_g50_ends_the_local_system_of_its_axes(read) -> None:
    reading = read("G52 X20. Z-5.\nG50 X0\nG52 X0 Z0\nM30")
    assert reading.of(SetCoordinates)[0].absolute == {0: 0.0}
    assert reading.of(ShiftCoordinates)[-1].shift == {0: 0.0, 1: 5.0}


def test_stroke_check(read) -> None:
    """G22 X Z I K: upper and lower bounds, X and I in diameter; alone it turns the check on; G23 off."""
    checks = read("G22 X100. Z50. I-60. K-70.\nG23\nG22\nG20\nG22 X1. I0\nM30").of(StrokeCheck)
    assert [(c.on, c.area) for c in checks] == [
        (True, {0: (-30.0, 50.0), 1: (-70.0, 50.0)}),
        (False, None),
        (True, None),
        (True, {0: (0.0, pytest.approx(12.7))}),
    ]


def test_reference_points(read) -> None:
    """G27 positions and checks; G30 P2 (also without P), P3, P4."""
    reading = read("G27 X5. W1.\nG30 U0\nG30 P3 X9. Z9.\nM30")
    assert [type(c).__name__ for _, c in reading.steps[:5]] == [
        "Move",
        "ReferenceCheck",
        "ReferenceReturn",
        "Move",
        "ReferenceReturn",
    ]
    assert reading.of(ReferenceCheck)[0].axes == (0, 1)
    assert [(c.axes, c.point) for c in reading.of(ReferenceReturn)] == [((0,), 2), ((0, 1), 3)]


@pytest.mark.parametrize("code", ["G28 H0", "G30 H0", "G27 H0", "G53 C0", "G50 C0", "G52 C5."])
def test_sync_axes_have_no_reference_and_no_zero_in_sync(alarm_in, code: str) -> None:
    """G28/G30 of a sync axis and what else moves its zero: PS1595 hobbing, PS0220 polygon."""
    assert alarm_in(f"G81 T20\n{code}\nM30") == ("PS1595", 2, 5)
    assert alarm_in(f"G51.2 P2 Q6\n{code}\nM30") == ("PS0220", 2, 5)


def test_offsets_may_be_set_in_sync(alarm_in) -> None:
    assert alarm_in("G81 T20\nG10 P1 X5.\nG10 L2 P1 Z5.\nG52 Z1.\nG80\nM30") is None


def test_tools(read) -> None:
    """T0203: tool 2, offset 3; the offset moves the zero point, not the axes; T0200 cancels it."""
    offsets = Offsets(tool={3: {"X": 8.0, "Z": -1.0}})
    reading = read("T0203\nG00 X0 Z0\nT0200\nM30", offsets=offsets)
    assert [tool.number for tool in reading.of(SelectTool)] == [2, 2]
    assert len(reading.of(Move)) == 1
    assert (reading.machine["X"], reading.absolute["X"]) == (8.0, 8.0)


def test_surface_speed_with_its_clamp(read) -> None:
    """G96 S in m/min, limited by G50 S; without G50 by the spindle itself."""
    (bare,) = read("G96 S150 M03\nM30").of(SurfaceSpeed)
    assert (bare.speed, bare.clamp) == (150.0, 2000.0)
    (clamped,) = read("G50 S800\nG96 S150 M04\nM30").of(SurfaceSpeed)
    assert (clamped.speed, clamped.clamp) == (-150.0, 800.0)


def test_surface_speed_in_feet(read) -> None:
    """In inch input S of G96 counts feet per minute, 0.3048 m: S300 is 91.44 m/min. #4119 shows it as it was
    programmed; G21 alone does not make metres of it, the next S does."""
    reading = read("G20 G96 S300 M03\nG21\nM04\nG00 Z#4119\nS300\nM30")
    assert [one.speed for one in reading.of(SurfaceSpeed)] == pytest.approx([91.44, -91.44, -300.0])
    assert reading.absolute["Z"] == 300.0
