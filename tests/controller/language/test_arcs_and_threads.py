"""Rulings, section 1: G02 G03 by I K and by R, G31, G32 as typed commands."""

import math

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from controller.commands import Arc, Skip, Thread
from controller.laws.arcs import centre_by_radius, equidistant

COORDINATE = st.floats(-500, 500, allow_nan=False)


@given(COORDINATE, COORDINATE, st.floats(1.0001, 50), st.booleans(), st.booleans())
def test_centre_by_radius(z: float, x: float, factor: float, clockwise: bool, long: bool) -> None:
    """The centre is as far from both ends as R says; it turns the right way by less, or more, than 180."""
    chord = math.hypot(z, x)
    assume(chord > 1e-3)
    radius = factor * chord / 2.0
    centre = centre_by_radius((z, x), -radius if long else radius, clockwise=clockwise)
    assert centre is not None
    assert math.hypot(*centre) == pytest.approx(radius, rel=1e-9)
    assert math.dist(centre, (z, x)) == pytest.approx(radius, rel=1e-9)
    first = math.atan2(-centre[1], -centre[0])
    last = math.atan2(x - centre[1], z - centre[0])
    sweep = (first - last if clockwise else last - first) % (2.0 * math.pi)
    assert (sweep > math.pi) is long


@given(COORDINATE, COORDINATE, COORDINATE, COORDINATE)
def test_equidistant_centre(z: float, x: float, cz: float, cx: float) -> None:
    """It lies on the perpendicular bisector of the chord, and no nearer point to the one given does."""
    assume(math.hypot(z, x) > 1e-2)
    found = equidistant((cz, cx), (z, x))
    assert math.hypot(*found) == pytest.approx(math.dist(found, (z, x)), rel=1e-6, abs=1e-6)
    moved = (found[0] - cz, found[1] - cx)
    assert moved[0] * x - moved[1] * z == pytest.approx(0.0, abs=1e-6 * (1 + math.hypot(cz, cx)) * 500)


@pytest.mark.parametrize(
    ("block", "end", "centre", "clockwise"),
    [
        ("G02 X20. Z-10. R10. F100", {0: 10.0, 1: -10.0}, (0.0, 10.0), True),
        ("G03 X20. Z-10. R10. F100", {0: 10.0, 1: -10.0}, (-10.0, 0.0), False),
        ("G02 X20. Z-10. I10. K0 F100", {0: 10.0, 1: -10.0}, (0.0, 10.0), True),
        ("G02 X20. Z-10. R-10. F100", {0: 10.0, 1: -10.0}, (-10.0, 0.0), True),
        ("G02 I5. F100", {}, (0.0, 5.0), True),
        ("G20 G03 X2. Z-1. K-1. F10", {0: 25.4, 1: -25.4}, (-25.4, 0.0), False),
    ],
)
def test_arcs(read, block: str, end: dict[int, float], centre: tuple[float, float], clockwise: bool) -> None:
    """X in diameter, I K R in radius; a negative R the long way; I K alone the full circle; inches.

    Worked by hand: from X0 Z0 to X20 Z-10 (10 along both axes); with Z to the right and X upwards the centre
    of the clockwise short arc lies right of the way, at Z0 and X +10.
    """
    (arc,) = read(f"{block}\nM30").of(Arc)
    assert arc.absolute == pytest.approx(end)
    assert arc.centre == pytest.approx(centre, abs=1e-9)
    assert (arc.plane, arc.clockwise, arc.incremental) == ((1, 0), clockwise, {})


def test_arcs_in_other_planes_and_helices(read) -> None:
    """G17 X Y with I J, G19 Y Z with J K on the tilted set-up; axes outside the plane go along."""
    arcs = read("G17 G02 X20. Y10. J10. F100\nG19 G03 Y0 Z10. K10. X5. C30.\nM30", "tilted").of(Arc)
    assert [(arc.plane, pytest.approx(arc.centre, abs=1e-9), arc.clockwise) for arc in arcs] == [
        ((0, 2), (0.0, 10.0), True),
        ((2, 1), (0.0, 10.0), False),
    ]
    assert arcs[1].absolute == {2: 0.0, 1: 10.0, 0: 2.5, 3: 30.0}


def test_increments_of_arcs(read) -> None:
    (arc,) = read("G50 X10. Z5.\nG02 U20. W-10. R10. F100\nM30").of(Arc)
    assert (arc.absolute, arc.incremental) == ({}, {0: 10.0, 1: -10.0})
    assert arc.centre == pytest.approx((0.0, 10.0), abs=1e-9)


@pytest.mark.parametrize(
    ("block", "expected"),
    [
        ("G02 X20. Z-10. F100", ("PS0022", 1, 1)),
        ("G02 X20. Z-10. R4. F100", ("PS0020", 1, 16)),
        ("G02 R4. F100", ("PS0020", 1, 5)),
        ("G02 X20. Z-10. R10. I5. F100", ("PS0022", 1, 21)),
        ("G02 X20. Z-10. I10.02 F100", ("PS0020", 1, 16)),
        ("G02 X20. Z-10. I0 K0 F100", ("PS0022", 1, 19)),
        ("G02 X20. Z-10. R10.", ("PS0011", 1, 1)),
        ("G02 X20. Z-10. J5. F100", ("PS0022", 1, 1)),
        ("G17 G02 X20. R10. F100", ("PS0021", 1, 1)),
        ("G00 X20. I5.", ("PS0009", 1, 10)),
    ],
)
def test_refused_arcs(alarm_in, block: str, expected: tuple[str, int, int]) -> None:
    assert alarm_in(f"{block}\nM30") == expected


def test_tolerance_of_the_radius(read) -> None:
    """PS0020 where the radius at the end differs by more than parameter 3410; within it the circle closes."""
    block = "G02 X20. Z-10. I10.005 F100\nM30"
    (arc,) = read(block).of(Arc)
    assert math.hypot(*arc.centre) == pytest.approx(math.dist(arc.centre, (-10.0, 10.0)), rel=1e-12)
    assert read(block, parameters={"3410": 0.001}).alarm.number == "PS0020"
    assert read("G02 X20. Z-10. I11. F100\nM30", parameters={"3410": 2}).alarm is None


@pytest.mark.parametrize("slave", ["G02 X5. R9. C90. F100", "G02 X5. R9. H90. F100"])
def test_arcs_in_sync(alarm_in, slave: str) -> None:
    """What sync forbids holds for arcs: no master; a helical slave only incrementally; polygon neither."""
    assert alarm_in("G81 T20\nG02 X5. R9. Y5. F100\nM30")[0] == "PS1595"
    helical = alarm_in(f"G81 T20 Q2. P20.\n{slave}\nG80\nM30")
    assert (helical and helical[0]) == ("PS1595" if "C" in slave else None)
    assert alarm_in(f"G51.2 P2 Q6\n{slave}\nM30")[0] == "PS0220"
    assert alarm_in(f"G81 T20\n{slave}\nG80\nM30") is None


def test_skip(read) -> None:
    """G31: one block, at feed; the motion code in force stays."""
    reading = read("G00 X1.\nG31 Z-5. F50\nX2.\nM30")
    (skip,) = reading.of(Skip)
    assert (skip.move.absolute, skip.move.feed.value) == ({1: -5.0}, 50 / 60)
    assert reading.steps[-2][1].feed is None
    assert read("G31\nM30").alarm.number == "HT9012"


def test_threads(read) -> None:
    """G32: F the lead per turn in any mode, Q the start angle in 0.001 deg, with a point in degrees."""
    threads = read("M03 S100\nG32 X20. Z-30. F2. Q180000\nW-5. Q90.\nG20 Z0 F0.1\nM30").of(Thread)
    assert [(t.lead, t.start_angle) for t in threads] == [
        (2.0, 180.0),
        (2.0, 90.0),
        (pytest.approx(2.54), 0.0),
    ]
    assert (threads[0].absolute, threads[1].incremental) == ({0: 10.0, 1: -30.0}, {1: -5.0})


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("G32 Z-5. F2.", ("HT9007", 1, 1)),
        ("M03 S100\nG32 Z-5.", ("PS0011", 2, 1)),
        ("M03 S100\nG32 Z-5. F2. Q361.", ("HT9012", 2, 14)),
        ("G81 T20\nS100\nG32 Z-5. F2.", ("PS1595", 3, 1)),
        ("G51.2 P2 Q6\nS100\nG92 X5. Z-5. F2.", ("PS0220", 3, 1)),
    ],
)
def test_refused_threads(alarm_in, text: str, expected: tuple[str, int, int]) -> None:
    assert alarm_in(f"{text}\nM30") == expected


@settings(max_examples=50, deadline=None)
@given(st.integers(1, 5000), st.integers(1, 5000), st.booleans())
def test_arcs_by_centre_and_by_radius_are_the_same(read, depth: int, width: int, clockwise: bool) -> None:
    """A quarter circle from a start below the centre: R and I K name the same one."""
    radius = depth / 100
    code = "G02" if clockwise else "G03"
    by_radius = f"{code} X{2 * radius:.3f} Z{-radius:.3f} R{radius:.3f} F{width}"
    centre = f"I{radius:.3f} K0" if clockwise else f"I0 K{-radius:.3f}"
    by_centre = f"{code} X{2 * radius:.3f} Z{-radius:.3f} {centre} F{width}"
    first, second = (read(f"{block}\nM30").of(Arc)[0] for block in (by_radius, by_centre))
    assert first.centre == pytest.approx(second.centre, abs=1e-9)
