"""G02 and G03 in motion: circles in every plane, their speeds and accelerations, their extents and limits."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from controller.clock import Feedback
from controller.cnc import Controller
from controller.dry_run import dry_run
from controller.language.source import parse_program
from controller.laws.arcs import arc_displacements
from controller.tables.parameters import delivered

RADIUS = {"1006#3.X": 0}


def sampled(text: str, setup: str = "hobbing", parameters=None, limit: int = 4096):
    controller = Controller(parse_program(text), parameters=delivered(setup, parameters))
    rows = [np.zeros((1, len(controller.axes)))]
    while (chunk := controller.propose(limit)).ticks:
        rows.append(chunk.setpoint)
        controller.commit(Feedback(ticks=chunk.ticks, setpoint=chunk.setpoint, actual=chunk.setpoint))
    assert controller.alarms == ()
    return np.concatenate(rows)


@given(
    st.floats(0.1, 100.0),
    st.floats(-math.pi, math.pi),
    st.floats(0.01, 6.27),
    st.booleans(),
    st.floats(-50.0, 50.0),
)
def test_geometry(radius: float, begin: float, sweep: float, clockwise: bool, helix: float) -> None:
    """Every point of the arc has the radius; its end and its sense are as commanded."""
    sense = -1.0 if clockwise else 1.0
    centre = (-radius * math.cos(begin), -radius * math.sin(begin))
    end = begin + sense * sweep
    travel = {4: centre[0] + radius * math.cos(end), 7: centre[1] + radius * math.sin(end), 2: helix}
    r, angle, waves = arc_displacements(travel, (4, 7), centre, clockwise=clockwise)
    assert r == pytest.approx(radius, rel=1e-12)
    assert angle == pytest.approx(sweep, rel=1e-6)
    for share in (0.0, 0.25, 0.5, 1.0):
        x, y = waves[4].at(share * angle), waves[7].at(share * angle)
        wanted = begin + sense * share * sweep
        assert x == pytest.approx(centre[0] + radius * math.cos(wanted), abs=1e-6)
        assert y == pytest.approx(centre[1] + radius * math.sin(wanted), abs=1e-6)
        assert waves[2].at(share * angle) == pytest.approx(share * helix, abs=1e-9)


def test_full_circle() -> None:
    r, sweep, waves = arc_displacements({0: 0.0, 1: 0.0}, (0, 1), (3.0, 4.0), clockwise=True)
    assert (r, sweep) == (5.0, 2 * math.pi)
    assert waves[0].at(math.pi) == pytest.approx(6.0)


@pytest.mark.parametrize(("code", "side"), [("G02", -1.0), ("G03", 1.0)])
def test_a_quarter_in_the_turning_plane(code: str, side: float) -> None:
    """G18, X above Z: from Z0 X0 to Z-10 X10 in radius. G02 goes clockwise seen from the side where X is up
    and Z to the right: over the top left corner or the bottom, the centre tells."""
    centre = "I10. K0" if code == "G02" else "I0 K-10."
    motion = sampled(f"{code} X10. Z-10. {centre} F600\nM30", parameters=RADIUS)
    x, z = motion[:, 0], motion[:, 1]
    cx, cz = (10.0, 0.0) if code == "G02" else (0.0, -10.0)
    assert np.hypot(x - cx, z - cz) == pytest.approx(10.0, abs=1e-9)
    turning = np.unwrap(np.arctan2(x - cx, z - cz))  # from Z+ towards X+ is counter-clockwise
    assert (turning[-1] - turning[0]) == pytest.approx(side * math.pi / 2, abs=1e-6)


def test_time_of_an_arc() -> None:
    """Length by speed, and one ramp of what the circle leaves of the acceleration."""
    found = dry_run(parse_program("G03 X10. Z-10. I0 K-10. F600\nM30"), delivered("hobbing", RADIUS))
    fastest = max(10.0 * 2.54, 2000.0 / 60.0)  # what the override, or dry run, could make of it
    rate = math.sqrt(2000.0**2 - (fastest**2 / 10.0) ** 2)
    length = 10.0 * math.pi / 2
    assert found.cycle_time_s == pytest.approx(length / 10.0 + 10.0 / rate, rel=1e-9)
    assert found.extents["X"].machine == pytest.approx((0.0, 10.0), abs=1e-9)


@settings(max_examples=40, deadline=None)
@given(st.floats(0.5, 60.0), st.integers(60, 8000), st.booleans())
def test_speeds_and_accelerations_stay_within_the_axes(radius: float, feed: int, half: bool) -> None:
    """Speed limited by v²/r within the acceleration and by each axis, all the way."""
    x = 0.0 if not half else -2 * radius
    text = f"G02 X{x:.3f} Z0 I{-radius:.3f} K0 F{feed}\nM30"
    motion = sampled(text, parameters=RADIUS | {"1320.X": 9000, "1321.X": -9000})
    speed = np.diff(motion[:, :2], axis=0) * 1000.0
    acceleration = np.diff(speed, axis=0) * 1000.0
    assert np.abs(speed).max() <= 8000.0 / 60.0 * (1 + 1e-6)
    inner = np.hypot(*acceleration.T)
    assert inner.max() <= 2000.0 * (1 + 1e-3)
    path = np.hypot(*speed.T)
    assert path.max() <= feed / 60.0 * (1 + 1e-6)


def test_extents_know_the_quadrants() -> None:
    """A half circle over the top reaches further than its ends."""
    found = dry_run(parse_program("G03 X0 Z-20. I0 K-10. F600\nM30"), delivered("hobbing", RADIUS))
    low, high = found.extents["X"].machine
    assert (low, high) == (0.0, pytest.approx(10.0, abs=1e-9))
    assert found.extents["X"].absolute == pytest.approx((0.0, 10.0), abs=1e-9)
    assert found.extents["Z"].machine == (-20.0, 0.0)


def test_stroke_limit_on_an_arc() -> None:
    """The limit is crossed between the ends: X 5 is reached at 30 degrees of the half circle."""
    parameters = RADIUS | {"1320.X": 5.0, "1300#7": 1}
    found = dry_run(parse_program("G03 X0 Z-20. I0 K-10. F600\nM30"), delivered("hobbing", parameters))
    (alarm,) = found.alarms
    assert (alarm.number, alarm.span.column) == ("OT0500", 5)
    assert found.machine["X"] == pytest.approx(5.0, abs=1e-9)
    assert found.machine["Z"] == pytest.approx(-10.0 + 10.0 * math.cos(math.radians(30)), abs=1e-6)


def test_arc_in_diameter() -> None:
    """X in diameter, I and R in radius: the metal sees a circle."""
    motion = sampled("G03 X20. Z-10. R10. F600\nM30")
    x, z = motion[:, 0], motion[:, 1]
    assert np.hypot(x, z + 10.0) == pytest.approx(10.0, abs=1e-9)


@pytest.mark.parametrize("angle", [-30000, 20000])
def test_circle_of_an_inclined_pair(angle: int) -> None:
    """The slides move so that the Cartesian point goes round: y = ya cos θ, x = xa + ya sin θ."""
    parameters = RADIUS | {"8200#0": 1, "8210": angle}
    motion = sampled("G28 Y0\nG28 X0\nG17 G02 X0 Y0 I10. J5. F600\nM30", "tilted", parameters)
    theta = math.radians(angle / 1000)
    xa, ya = motion[:, 0], motion[:, 2]
    x, y = xa + ya * math.sin(theta), ya * math.cos(theta)
    assert np.hypot(x - 10.0, y - 5.0) == pytest.approx(math.hypot(10.0, 5.0), abs=1e-9)
    assert np.ptp(x) == pytest.approx(2 * math.hypot(10.0, 5.0), abs=1e-3)


def test_axial_travel_of_an_arc_turns_the_slave() -> None:
    """ΔZ of a helical gear counts on arcs, too (crowning by an arc)."""
    text = "G81 T20 L1 Q2. P20.\nG03 X0 Z-20. R50. F900\nG80\nM30"
    motion = sampled(text, parameters=RADIUS)
    rate = -360 * math.sin(math.radians(20)) / (math.pi * 20 * 2)
    assert motion[:, 3] == pytest.approx(rate * motion[:, 1], abs=1e-9)


def test_every_limit_gives_the_same_bits() -> None:
    text = "G02 X3. Z-7. R20. F900\nG03 X0 Z-9. R15.\nG01 X-1. F300\nG02 X-1. Z-9. I1. K2.\nM30"
    reference = sampled(text).tobytes()
    for limit in (1, 7, 100):
        assert sampled(text, limit=limit).tobytes() == reference
