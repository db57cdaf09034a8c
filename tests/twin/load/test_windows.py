"""Windows of a run under forces: where they end, that they change nothing, what rounds in them come to."""

import numpy as np
import pytest
from polygon_job import Polygon

from twin.cutting.cut import cut
from twin.load.agreement import Agreement
from twin.load.forces import Clock, CuttingLoad, cutting_load
from twin.load.material import material_of
from twin.load.removal import removal
from twin.load.rounds import MOST_ROUNDS, SETTLED_UM
from twin.load.windows import windows

PHYSICS = "cutting_load = true\nload_resolution_mm = 0.3\ntool_stiffness_n_per_um = 50.0\nk_c11 = 500.0"
WHOLE = 10**6


def turning(ticks, deg_per_tick):
    return np.cumsum(np.full(ticks, deg_per_tick)), np.arange(ticks)


@pytest.mark.parametrize(("speed", "shortest"), [(1.8, 1000), (3.6, 250), (0.18, 100), (-1.8, 700)])
def test_windows_are_whole_turns_with_room_around_them(speed, shortest):
    angle, tick = turning(20_000, speed)
    *found, last = windows(angle, tick, shortest=shortest)
    assert (last.until, last.end) == (None, None)
    begin = known = 0
    for one in found:
        assert one.until is not None
        assert one.end is not None
        assert one.until - begin >= 0.9 * shortest or not begin
        # half a turn before its end forces are final; a turn after it motion is known
        assert (one.until - one.known) * abs(speed) == pytest.approx(180.0, abs=3.0 * abs(speed))
        assert (one.end - one.until) * abs(speed) == pytest.approx(360.0, abs=3.0 * abs(speed))
        assert one.known > known
        turns = (one.until - begin) * abs(speed) / 360.0
        assert begin == 0 or abs(turns - round(turns)) * 360.0 < 3.0 * abs(speed)
        begin, known = one.until, one.known
    assert begin > 14_000


def test_a_tool_that_stands_has_one_window():
    assert len(windows(np.zeros(5000), np.arange(5000))) == 1
    assert len(windows(np.zeros(0), np.zeros(0, np.int64))) == 1


def test_a_fork_goes_on_as_the_course_itself(tmp_path):
    """Bit by bit, wherever it was forked and whatever the other has done since."""
    polygon = Polygon(tmp_path, physics="")
    straight = polygon.begin(ideal=False)
    straight.go(until=2500)
    course = polygon.begin(ideal=False)
    course.go(until=777)
    forks = [course.fork(), course.fork()]
    forks[0].go(until=1500, load=lambda _first, ticks: np.full((ticks, 4), 50.0))
    deeper = forks[1].fork()
    for one in (course, forks[1], deeper):
        one.go(until=2500)
        np.testing.assert_array_equal(one.tape().actual, straight.tape().actual)
        np.testing.assert_array_equal(one.tape().setpoint, straight.tape().setpoint)
        np.testing.assert_array_equal(one.tape(since=2000).time, straight.tape().time[2000:])
    assert not np.array_equal(forks[0].tape().actual[800:], straight.tape().actual[800:1500])


@pytest.mark.parametrize("ideal", [True, False])
def test_shorter_windows_change_nothing(tmp_path, ideal):
    """One window over the whole run, or many: the same motion within what rounds may leave."""
    polygon = Polygon(tmp_path, physics=PHYSICS)
    whole = polygon.loaded(ideal=ideal, shortest=WHOLE)
    assert (whole.windows, whole.settled) == (1, True)
    for shortest in (700, 250):
        parts = polygon.loaded(ideal=ideal, shortest=shortest)
        assert parts.settled
        assert parts.windows > 2
        (_, a), (_, b) = whole.session.motions[0], parts.session.motions[0]
        off = np.linalg.norm(b.centre - a.centre, axis=1) + 10.0 * np.abs(b.work_angle - a.work_angle)
        assert 1e3 * off.max() < 2.0 * SETTLED_UM
        assert parts.energy_j == pytest.approx(whole.energy_j, rel=1e-3)


def test_forces_that_acted_are_those_of_the_delivered_motion(tmp_path):
    """All metal of the whole run counted again at once, without windows: the same forces, deflections and
    volume, and the volume is what the part has lost."""
    polygon = Polygon(tmp_path, physics=PHYSICS)
    loaded = polygon.loaded(ideal=False, shortest=250)
    job, ready, session = polygon.job, polygon.ready, loaded.session
    metal = removal(job.work.blank(), session.motions, resolution_mm=0.3)
    again = cutting_load(
        metal,
        [motion for _, motion in session.motions],
        kinematics=ready.tools[0].kinematics,
        material=material_of(job.work.material, job.physics),
        physics=job.physics,
        clock=Clock.of(session.recording, loaded.tick_s),
    )
    ticks = np.arange(len(session.recording.time_s))
    off = again.deflection_um(ticks) - loaded.load.deflection_um(ticks)
    assert np.linalg.norm(off, axis=1).max() < 3.0 * SETTLED_UM
    assert loaded.removed_mm3 == pytest.approx(metal.volume_mm3.sum(), rel=1e-3)
    part = cut(job.work.blank(), session.motions, cell_mm=0.2).remains
    assert loaded.removed_mm3 == pytest.approx(part.blank_volume_mm3 - part.volume_mm3, rel=0.01)


def constant(force, ticks):
    n = len(ticks)
    return CuttingLoad(
        spindle=2,
        angle=(ticks, 1.8 * ticks),
        cell=ticks,
        axes=np.zeros((n, 4)),
        tool=np.column_stack([force, np.zeros((n, 2))]),
        power_w=np.abs(force) + 1.0,
        removed_mm3=np.ones(n),
        compliance_um_per_n=0.02,
    )


def rounds_of(gain, free=500.0, ticks=64, most=60):
    """An edge on a spring: F = F_0 - g F'. Rounds until it is right to 1 N of F_0 / (1 + g), or None."""
    at = np.arange(ticks)
    agreement, tried = Agreement(), np.zeros(ticks)
    for number in range(1, most + 1):
        caused = free - gain * tried
        if np.abs(tried - caused).max() < 1.0:
            np.testing.assert_allclose(tried, free / (1.0 + gain), atol=1.0 / (1.0 + gain) + 1e-9)
            return number
        if np.abs(tried).max() > 1e9:
            return None
        load = agreement.after(constant(tried, at), constant(caused, at))
        tried = load.tool_force(at)[:, 0]
    return None


@pytest.mark.parametrize("gain", [0.1, 0.5, 0.99, 1.5, 4.0, 9.0])
def test_a_spring_that_gives_way_is_settled_however_soft(gain):
    """Plain rounds would diverge from g = 1 on; the secant has it in four."""
    assert (rounds_of(gain) or 99) <= 4


@pytest.mark.parametrize(("gain", "settles"), [(-0.5, True), (-0.9, True), (-1.05, False), (-2.0, False)])
def test_a_force_that_digs_in_is_unstable_from_g_one_on(gain, settles):
    """F_0 / (1 + g) has its pole at g = -1: beyond it every give brings more force than gave way."""
    assert (rounds_of(gain) is not None) is settles


def test_lumped_turning_with_a_memory():
    """A tool on a spring that meets its own surface each turn: y_n = c K (h + y_{n-1} - y_n), marched turn
    by turn. Rounds over windows of three turns, with the turns before them final, come to the same."""
    stiffness, spring, feed, turns = 12.0, 20.0, 100.0, 12
    gain = stiffness / spring
    y, marched = 0.0, []
    for _ in range(turns):
        y = gain / (1.0 + gain) * (feed + y)
        marched.append(spring * y)
    at = np.arange(turns)

    def caused(tried):
        gives = tried / spring
        return stiffness * np.maximum(feed - gives + np.concatenate([[0.0], gives[:-1]]), 0.0)

    found = np.zeros(turns)
    for first in range(0, turns, 3):
        agreement = Agreement()
        for _ in range(MOST_ROUNDS):
            tried = found.copy()
            new = agreement.after(constant(tried, at), constant(caused(tried), at)).tool_force(at)[:, 0]
            found[first : first + 3] = new[first : first + 3]
            found[first + 3 :] = 0.0
    np.testing.assert_allclose(found, marched, rtol=2e-3)
    assert marched[-1] == pytest.approx(stiffness * feed, rel=0.01)
