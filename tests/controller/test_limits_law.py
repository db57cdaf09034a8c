"""Stroke limits as laws: straight paths and arcs against boxes, held against dense sampling."""

import math
from collections.abc import Mapping
from itertools import pairwise

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from controller.commands import StrokeCheck
from controller.laws.inclined import Frame
from controller.laws.stroke_area import Area, Limit
from controller.laws.wave import Wave, circle
from controller.motion.limits import StrokeLimits
from controller.tables.alarms import AlarmClass
from controller.tables.machine_data import machine_data
from controller.tables.parameters import delivered

NEAR = 1e-6
"""[mm] positions closer than this to a face are left to either side of it"""
coordinate = st.integers(-40, 40).map(lambda k: k / 4.0)
point = st.tuples(coordinate, coordinate)


def box(forbidden: bool, lower=(-5.0, -4.0), upper=(5.0, 4.0)) -> Area:
    limit = Limit.STROKE_3 if forbidden else Limit.STROKE_1
    return Area(limit=limit, frame=Frame.SLIDES, lower=lower, upper=upper, forbidden=forbidden)


def depth(position, area: Area) -> float:
    return min(min(p - low, high - p) for p, low, high in zip(position, area.lower, area.upper, strict=True))


def offends(position, area: Area) -> bool:
    inside = depth(position, area)
    return inside > NEAR if area.forbidden else inside < -NEAR


def on_line(start, travel, t: float) -> tuple[float, ...]:
    return tuple(a + t * b for a, b in zip(start, travel, strict=True))


@given(st.booleans(), point, point)
def test_straight_path_up_to_its_limit_is_allowed_and_beyond_is_not(forbidden, start, travel) -> None:
    """From an allowed start: nothing before the crossing offends, and just behind it the path does."""
    area = box(forbidden)
    assume(not offends(start, area) and any(travel))
    found = area.straight(start, travel)
    end = found.fraction if found else 1.0
    assert 0.0 <= end <= 1.0
    assert not any(offends(on_line(start, travel, end * k / 200), area) for k in range(201))
    if found:
        assert offends(on_line(start, travel, min(1.0, end + 1e-5)), area) or end > 1 - 1e-5
        place = on_line(start, travel, end)[found.axis]
        assert place == pytest.approx(found.bound, abs=1e-9)
        assert found.upper == (travel[found.axis] > 0)


@given(point, point)
def test_from_inside_a_forbidden_box_only_outwards(start, travel) -> None:
    """A path may leave what is forbidden where it stands in it, but not go further in."""
    area = box(True)
    assume(depth(start, area) > NEAR and any(travel))
    step = on_line(start, travel, 1e-6)
    found = area.straight(start, travel)
    if depth(step, area) > depth(start, area):
        assert found
        assert found.fraction == 0.0
    else:
        assert found is None


@pytest.mark.parametrize(
    ("start", "travel", "expected"),
    [
        ((8.0, 0.0), (-4.0, 0.0), None),  # already outside: it may come back
        ((8.0, 0.0), (1.0, 0.0), (0.0, 0, True)),  # but not go further out
        ((8.0, 0.0), (-4.0, 8.0), (0.5, 1, True)),
        ((0.0, 0.0), (5.0, 4.0), None),  # a path that ends on the limit is inside
        ((0.0, 0.0), (-10.0, 0.0), (0.5, 0, False)),
        ((0.0, 0.0), (10.0, 16.0), (0.25, 1, True)),
    ],
)
def test_allowed_box_by_hand(start, travel, expected) -> None:
    found = box(False).straight(start, travel)
    assert (found and (found.fraction, found.axis, found.upper)) == expected


@pytest.mark.parametrize(
    ("start", "travel", "expected"),
    [
        ((10.0, 0.0), (-10.0, 0.0), (0.5, 0, False)),
        ((10.0, 4.0), (-20.0, 0.0), None),  # along the face
        ((10.0, 8.0), (-20.0, -16.0), (0.25, 1, False)),  # (5, 4), a corner: the later face names the axis
        ((0.0, 10.0), (2.0, -5.0), None),
        ((0.0, 3.0), (0.0, 4.0), None),  # inside, by the near face out
        ((0.0, 3.0), (0.0, -4.0), (0.0, 1, False)),  # inside, deeper
    ],
)
def test_forbidden_box_by_hand(start, travel, expected) -> None:
    found = box(True).straight(start, travel)
    assert (found and (found.fraction, found.axis, found.upper)) == expected


wave = st.builds(Wave, coordinate, coordinate, coordinate, coordinate)
sweep = st.floats(0.05, 4 * math.pi)


@given(wave, sweep)
def test_a_wave_is_monotone_between_its_turns(one: Wave, end: float) -> None:
    ends = [0.0, *one.turning(end), end]
    assert ends == sorted(ends)
    for low, high in pairwise(ends):
        samples = [one.at(low + (high - low) * k / 50) for k in range(51)]
        rising = [b - a for a, b in pairwise(samples)]
        assert all(d >= -1e-9 for d in rising) or all(d <= 1e-9 for d in rising)


@given(wave, st.floats(0.01, 6.0), st.floats(0.0, 1.0))
def test_a_wave_stays_within_its_bounds(one: Wave, end: float, part: float) -> None:
    low, high = one.bounds(end)
    assert low - 1e-9 <= one.at(part * end) <= high + 1e-9


@given(wave, sweep, coordinate)
def test_a_wave_has_a_value_exactly_where_its_sign_changes(one: Wave, end: float, value: float) -> None:
    places = one.reaches(value, end)
    assert places == sorted(places)
    assert all(one.at(u) == pytest.approx(value, abs=1e-6) for u in places)
    marks = [0.0, *places, end]
    for low, high in pairwise(marks):
        signs = {
            math.copysign(1.0, one.at(low + (high - low) * k / 40) - value)
            for k in range(1, 40)
            if abs(one.at(low + (high - low) * k / 40) - value) > 1e-6
        }
        assert len(signs) <= 1


@given(coordinate, coordinate, st.tuples(coordinate, coordinate), st.sampled_from((1, -1)), sweep)
def test_circle_keeps_its_radius_and_sense(x, y, offset, sense, end) -> None:
    """I and K lead from the start to the centre; the radius stays, the sense is that of the first axis
    towards the second."""
    assume(any(offset))
    i, k = offset
    first, second = circle(x, i, k, sense), circle(y, k, i, -sense)
    centre, radius = (x + i, y + k), math.hypot(i, k)
    assert (first.at(0.0), second.at(0.0)) == pytest.approx((x, y))
    there = first.at(end) - centre[0], second.at(end) - centre[1]
    assert math.hypot(*there) == pytest.approx(radius)
    cross = (x - centre[0]) * second.slope(0.0) - (y - centre[1]) * first.slope(0.0)
    assert cross == pytest.approx(sense * radius * radius)


@given(st.booleans(), point, point, st.sampled_from((1, -1)), st.floats(0.05, 2 * math.pi))
def test_arc_up_to_its_limit_is_allowed_and_beyond_is_not(forbidden, start, offset, sense, end) -> None:
    area = box(forbidden)
    assume(any(offset) and not offends(start, area))
    (x, y), (i, k) = start, offset
    waves = (circle(x, i, k, sense), circle(y, k, i, -sense))
    found = area.arc(waves, end)
    stop = found.fraction * end if found else end
    for n in range(201):
        u = stop * n / 200
        assert not offends((waves[0].at(u), waves[1].at(u)), area)
    if found and stop < end - 0.02:
        later = [stop + 0.02 * n / 100 for n in range(1, 101)]
        assert any(
            depth((waves[0].at(u), waves[1].at(u)), area) * (1 if forbidden else -1) > 0 for u in later
        )
        assert waves[found.axis].at(stop) == pytest.approx(found.bound, abs=1e-6)


@given(point, point, st.floats(0.2, 3.0))
def test_an_arc_without_curvature_is_a_straight_path(start, travel, end) -> None:
    for forbidden in (False, True):
        area = box(forbidden)
        waves = [Wave(a, rate=b / end) for a, b in zip(start, travel, strict=True)]
        straight, arc = area.straight(start, travel), area.arc(waves, end)
        assume(any(travel) and abs(depth(start, area)) > NEAR)
        assert (straight is None) == (arc is None) or min(
            abs(depth(on_line(start, travel, k / 500), area)) for k in range(501)
        ) < 0.1
        if straight and arc:
            assert arc.fraction == pytest.approx(straight.fraction, abs=1e-6)


def limits(parameters: Mapping[str, float] | None = None) -> StrokeLimits:
    """Of the tilted set-up (X Z Y C B) with X in radius."""
    return StrokeLimits.of(machine_data(delivered("tilted", {"1006#3.X": 0, **(parameters or {})})))


AT_ZERO = (0.0,) * 5


def test_delivered_parameters_leave_limits_2_and_3_off() -> None:
    assert [area.limit for area in limits().areas] == [Limit.STROKE_1]
    on = limits().after(StrokeCheck(on=True))
    assert [area.limit for area in on.areas] == [Limit.STROKE_1]


@pytest.mark.parametrize(
    ("outside", "travel", "number"),
    [
        (0, (60.0, 0.0, 0.0, 0.0, 0.0), "OT0502"),
        (0, (-60.0, 0.0, 0.0, 0.0, 0.0), None),
        (1, (60.0, 0.0, 0.0, 0.0, 0.0), "OT0502"),
        (1, (-60.0, 0.0, 0.0, 0.0, 0.0), "OT0503"),
    ],
)
def test_limit_2_forbids_what_out_says(outside: int, travel, number: str | None) -> None:
    """1300#0 OUT: 0 = the inside of the area of G22 is forbidden, 1 = the outside; G23 switches it off."""
    area = {0: (20.0, 40.0)} if not outside else {0: (-20.0, 40.0)}
    on = limits({"1300#0": outside}).after(StrokeCheck(on=True, area=area))
    found = on.straight(AT_ZERO, travel)
    assert (found and found.number) == number
    assert on.after(StrokeCheck(on=False)).straight(AT_ZERO, travel) is None
    again = on.after(StrokeCheck(on=False)).after(StrokeCheck(on=True)).straight(AT_ZERO, travel)
    assert (again and again.number) == number


def test_limits_2_and_3_from_parameters_and_their_axis_bits() -> None:
    """1322/1323 and 1324/1325 by axis; 1310#0 and #1 say which axes are checked."""
    two = limits({"1322.X": 40, "1323.X": 20})
    assert two.straight(AT_ZERO, (50.0, 0, 0, 0, 0)) is None
    assert two.after(StrokeCheck(on=True)).straight(AT_ZERO, (50.0, 0, 0, 0, 0)).fraction == 0.4
    three = limits({"1324.X": 40, "1325.X": 20})
    assert three.straight(AT_ZERO, (50.0, 0, 0, 0, 0)).number == "OT0504"
    assert three.straight((50.0, 0, 0, 0, 0), (-50.0, 0, 0, 0, 0)).number == "OT0505"
    off = limits({"1324.X": 40, "1325.X": 20, "1310#1.X": 0})
    assert off.straight(AT_ZERO, (50.0, 0, 0, 0, 0)) is None


def test_several_areas_the_first_one_counts() -> None:
    both = limits({"1320.X": 30, "1324.X": 40, "1325.X": 35})
    assert both.straight(AT_ZERO, (50.0, 0, 0, 0, 0)).number == "OT0500"
    both = limits({"1320.X": 45, "1324.X": 40, "1325.X": 35})
    assert both.straight(AT_ZERO, (50.0, 0, 0, 0, 0)).number == "OT0504"


@pytest.mark.parametrize(("bit", "before"), [(0, False), (1, True)])
def test_bfa_holds_for_limits_1_and_3_not_for_2(bit: int, before: bool) -> None:
    """1300#7, 对 OT1 和 OT3 有效."""
    three = limits({"1300#7": bit, "1324.X": 40, "1325.X": 20, "1322.Z": 40, "1323.Z": 20})
    three = three.after(StrokeCheck(on=True))
    assert {area.limit: area.before for area in three.areas} == {
        Limit.STROKE_1: before,
        Limit.STROKE_2: False,
        Limit.STROKE_3: before,
    }


def test_rotary_axes_have_no_limits() -> None:
    free = limits({"1310#0.C": 1, "1310#1.C": 1, "1324.C": 40, "1325.C": 20}).after(StrokeCheck(on=True))
    assert free.straight(AT_ZERO, (0.0, 0.0, 0.0, 1e6, -1e6)) is None


def test_the_cartesian_area_is_a_parallelogram_on_the_slides() -> None:
    """θ = −30°: slides (0, 100) are Cartesian (−50, 86.603) (worked case G53 Y100)."""
    on = {"8200#0": 1, "1321.X": -40}
    slides = limits(on).straight(AT_ZERO, (0.0, 0.0, 100.0, 0.0, 0.0))
    assert slides is None
    found = limits({**on, "8201#0": 1}).straight(AT_ZERO, (0.0, 0.0, 100.0, 0.0, 0.0))
    assert (found.number, found.axis, found.frame) == ("OT0501", 0, Frame.CARTESIAN)
    assert found.fraction == pytest.approx(40.0 / 50.0)
    waves = {2: Wave(0.0, rate=100.0)}
    assert limits({**on, "8201#0": 1}).arc(AT_ZERO, waves, 1.0).fraction == pytest.approx(0.8)


def test_slides_leave_a_box_that_the_cartesian_position_keeps_to() -> None:
    """Cartesian Y100 X0 is slide X57.735 (worked case): its plus limit at 50 is hit at 86.6 % of the way."""
    way = (100 * math.tan(math.radians(30)), 0.0, 100 / math.cos(math.radians(30)), 0.0, 0.0)
    on = {"8200#0": 1, "1320.X": 50}
    found = limits(on).straight(AT_ZERO, way)
    assert (found.number, found.axis) == ("OT0500", 0)
    assert found.fraction == pytest.approx(50 / 57.735, abs=1e-5)
    assert limits({**on, "8201#0": 1}).straight(AT_ZERO, way) is None


@pytest.mark.parametrize(
    ("parameters", "number"),
    [
        ({}, None),
        ({"1301#7": 1}, "OT0510"),
        ({"1301#7": 1, "8200#0": 1}, None),  # slant coordinates: the function does not act
        ({"1301#7": 1, "8200#0": 1, "8201#0": 1}, "OT0510"),
        ({"1301#7": 1, "8200#0": 1, "8201#1": 1}, None),  # that is limit 2
    ],
)
def test_check_before_motion(parameters: dict[str, float], number: str | None) -> None:
    """移动前行程检测: of an inclined pair only where the limit is set Cartesian."""
    found = limits({"1320.Z": 30, **parameters}).before_motion(AT_ZERO, (0.0, 40.0, 0.0, 0.0, 0.0))
    assert (found and found.number) == number
    assert found is None or found.fraction == 0.0
    inside = limits({"1320.Z": 30, **parameters}).before_motion(AT_ZERO, (0.0, 30.0, 0.0, 0.0, 0.0))
    assert inside is None


def test_check_before_motion_looks_at_the_end_alone() -> None:
    through = limits({"1301#7": 1, "1324.X": 40, "1325.X": 20})
    assert through.before_motion(AT_ZERO, (50.0, 0, 0, 0, 0)) is None
    assert through.before_motion(AT_ZERO, (30.0, 0, 0, 0, 0)).number == "OT0510"


@pytest.mark.parametrize(("way", "number"), [(1.0, "OT0506"), (-1.0, None)])
def test_limit_switch_stops_the_slide_but_lets_it_back(way: float, number: str | None) -> None:
    """*+Lx acts on the slide: OT0506; *-Lx: OT0507."""
    on = limits().on_switches(frozenset({2}), frozenset())
    found = on.straight(AT_ZERO, (0.0, 0.0, way, 0.0, 0.0))
    assert (found and found.number) == number
    other = limits().on_switches(frozenset(), frozenset({2}))
    assert other.straight(AT_ZERO, (0.0, 0.0, -1.0, 0.0, 0.0)).number == "OT0507"


def test_limit_switch_on_an_arc_stops_where_the_slide_turns_towards_it() -> None:
    """X = −10 sin u first runs back for a quarter turn and then towards its plus side."""
    on = limits().on_switches(frozenset({0}), frozenset())
    found = on.arc(AT_ZERO, {0: Wave(0.0, sine=-10.0), 1: Wave(-10.0, cosine=10.0)}, math.pi)
    assert (found.number, found.fraction) == ("OT0506", pytest.approx(0.5))


def test_the_message_names_slide_limit_and_remedy() -> None:
    one = limits({"1320.X": 30})
    error = one.refuse(one.straight(AT_ZERO, (40.0, 0, 0, 0, 0)), None).alarm
    assert error.found == "slide X at its limit 30.000 mm"
    assert error.remedy == "a path inside parameter 1320.X"
    assert error.kind is AlarmClass.OVERTRAVEL
    two = limits().after(StrokeCheck(on=True, area={1: (-40.0, -20.0)}))
    error = two.refuse(two.straight(AT_ZERO, (0, -50.0, 0, 0, 0)), None).alarm
    assert (error.number, error.found) == ("OT0503", "slide Z at its limit -20.000 mm")
    assert error.remedy == "a path outside the area of G22, or G23"
    on = limits().on_switches(frozenset(), frozenset({1}))
    error = on.refuse(on.straight(AT_ZERO, (0, -1.0, 0, 0, 0)), None).alarm
    assert error.found == "slide Z on its limit switch, *-LZ = 0"
