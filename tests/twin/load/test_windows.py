"""Windows of a run under forces: that they change nothing, and what a round in them comes to."""

import numpy as np
import pytest
from polygon_job import Polygon, clock_of, metal_of

from twin.cutting.cut import cut
from twin.load.forces import Stiff, cutting_load
from twin.load.material import material_of
from twin.load.mounts import balanced
from twin.load.rounds import SETTLED_UM
from twin.load.timeline import CuttingLoad

PHYSICS = "cutting_load = true\nload_resolution_mm = 0.3\ntool_stiffness_n_per_um = 50.0\nk_c11 = 500.0"


def test_a_trial_leaves_the_course_where_it_is(tmp_path):
    """Bit by bit, whatever was tried before."""
    polygon = Polygon(tmp_path, physics="")
    straight, course = polygon.begin(ideal=False), polygon.begin(ideal=False)
    straight.go()
    while (chunk := course.ahead(777)) is not None:
        other = course.trial(chunk, lambda _first, ticks: np.full((ticks, 4), 50.0)).feedback
        trial = course.trial(chunk)
        again = trial.feedback
        taken = course.take(chunk)
        np.testing.assert_array_equal(again.actual, taken.actual)
        assert not np.array_equal(other.actual, taken.actual)
    for name in ("time", "actual", "setpoint"):
        np.testing.assert_array_equal(getattr(course.tape(), name), getattr(straight.tape(), name))
    tried = polygon.begin(ideal=False)
    while (chunk := tried.ahead(777)) is not None:
        tried.take(chunk, tried=tried.trial(chunk))
    np.testing.assert_array_equal(tried.tape().actual, straight.tape().actual)
    np.testing.assert_array_equal(course.tape(since=2000).time, straight.tape().time[2000:])


@pytest.mark.parametrize("ideal", [True, False])
def test_shorter_windows_change_nothing(tmp_path, ideal):
    """However a run is divided: the same motion within what rounds may leave."""
    polygon = Polygon(tmp_path, physics=PHYSICS)
    one = polygon.loaded(ideal=ideal, ticks=64)
    assert one.settled
    for ticks in (3,):
        other = polygon.loaded(ideal=ideal, ticks=ticks)
        assert other.settled
        assert other.windows >= one.windows
        (_, a), (_, b) = one.session.motions[0], other.session.motions[0]
        off = np.linalg.norm(b.centre - a.centre, axis=1) + 10.0 * np.abs(b.work_angle - a.work_angle)
        assert 1e3 * off.max() < 3.0 * SETTLED_UM
        assert other.energy_j == pytest.approx(one.energy_j, rel=1e-3)
        assert other.removed_mm3 == pytest.approx(one.removed_mm3, rel=1e-3)


def test_forces_that_acted_are_those_of_the_delivered_motion(tmp_path):
    """All metal of the whole run counted again at once, without windows: the same forces, deflections and
    volume, and the volume is what the part has lost."""
    polygon = Polygon(tmp_path, physics=PHYSICS)
    loaded = polygon.loaded(ideal=False)
    job, ready, session = polygon.job, polygon.ready, loaded.session
    (tool,) = session.motions
    metal = metal_of(job.work.blank(), tool, 0.3)
    again = cutting_load(
        metal,
        tool[1],
        kinematics=ready.tools[0].kinematics,
        material=material_of(job.work.material, job.physics),
        physics=job.physics,
        compliance_um_per_n=loaded.stiffness.compliance_um_per_n,
        clock=clock_of(session.recording),
    ).load
    ticks = np.arange(len(session.recording.time_s))
    off = again.deflection_um(ticks) - loaded.load.deflection_um(ticks)
    assert np.linalg.norm(off, axis=1).max() < 3.0 * SETTLED_UM
    assert loaded.removed_mm3 == pytest.approx(metal.volume_mm3.sum(), rel=1e-3)
    assert loaded.energy_j == pytest.approx(again.power_w.sum() * 1e-3 / again.parts, rel=1e-3)
    part = cut(job.work.blank(), session.motions, cell_mm=0.2).remains
    assert loaded.removed_mm3 == pytest.approx(part.blank_volume_mm3 - part.volume_mm3, rel=0.01)


def spring(force, gain, ticks, compliance=0.02):
    """Forces (n,) along X of an edge that gives way by c F and bears gain/c less for it, tick by tick."""
    n = len(ticks)
    load = CuttingLoad(
        spindle=2,
        angle=(ticks, 1.8 * ticks),
        cell=ticks,
        axes=np.zeros((n, 4)),
        tool=np.column_stack([force, np.zeros((n, 2))]),
        power_w=np.abs(force) + 1.0,
        removed_mm3=np.ones(n),
        compliance_um_per_n=compliance,
    )
    slope = np.zeros((n, 3, 3))
    slope[:, 0, 0] = -1e3 * gain / compliance
    return Stiff(
        load=load, axes=np.zeros((n, 4, 3)), tool=slope, power_w=np.zeros((n, 3)), removed_mm3=slope[:, 0]
    )


@pytest.mark.parametrize("gain", [0.0, 0.1, 1.0, 9.0, 1000.0])
def test_a_spring_that_gives_way_is_in_balance_at_once_however_soft(gain):
    """F = F₀ − g F: F₀ / (1 + g), for a force that stays as it is from tick to tick."""
    free, ticks = 500.0, np.arange(10, 50)
    wanted = free / (1.0 + gain)
    before = spring(np.full(10, wanted), gain, np.arange(10)).load
    found = balanced(spring(np.full(40, free), gain, ticks), before, np.zeros((40, 3)), first=10)
    np.testing.assert_allclose(found.tool[:, 0], wanted, rtol=1e-9)
    # what is in balance stays so
    again = balanced(
        spring(found.tool[:, 0], gain, ticks), before, np.full((40, 3), [0.02 * wanted, 0, 0]), first=10
    )
    np.testing.assert_allclose(again.tool[:, 0], wanted, rtol=1e-9)


def test_a_tooth_out_of_the_metal_does_not_pull():
    """Pushed further off than its chip is thick it bears nothing: F₀ − S δ would be less."""
    ticks = np.arange(10, 14)
    found = spring(np.array([500.0, 500.0, 5.0, 500.0]), 0.9, ticks)
    power = np.array([[-1e6, 0.0, 0.0]] * 4)
    stiff = Stiff(
        load=found.load, axes=found.axes, tool=found.tool, power_w=power, removed_mm3=found.removed_mm3
    )
    before = spring(np.full(10, 250.0), 0.9, np.arange(10)).load
    load = balanced(stiff, before, np.zeros((4, 3)), first=10)
    assert not load.tool.any()
    assert not load.power_w.any()
