"""Cutting forces: Kienzle by hand, chips against areas of circles, energy, mounts, rounds that settle."""

import math
from dataclasses import replace

import numpy as np
import pytest
from polygon_job import HEAD, JOB, PROGRAM, Polygon, clock_of, metal_of

from twin.cutters.polygon_head import PolygonHead
from twin.cutting.blank import Blank
from twin.cutting.cut import cut
from twin.cutting.motion import CutterMotion
from twin.errors import ExitCode, InputError
from twin.job import read_job
from twin.load.figures import load_figures
from twin.load.forces import Clock, cutting_load
from twin.load.material import MATERIALS, Material, Physics, material_of
from twin.load.rounds import MOST_ROUNDS, SETTLED_UM

BAR = Blank(diameter_mm=20.0, length_mm=3.0)
FLY = PolygonHead(inserts=1, tip_radius_mm=30.0)
STEPS = (0.8, 0.6, 0.5, 0.9)
"""infeed before each turn of the fly cutter [mm]"""


def lens(depth, r=10.0, radius=30.0):
    """Area common to the bar's circle and the tool's, `depth` into each other."""
    d = r + radius - depth
    one = math.acos((d * d + r * r - radius * radius) / (2 * d * r))
    two = math.acos((d * d + radius * radius - r * r) / (2 * d * radius))
    return r * r * (one - math.sin(2 * one) / 2) + radius * radius * (two - math.sin(2 * two) / 2)


@pytest.fixture(scope="module")
def fly(synthetic):
    """One insert, 2 mm wide, the bar at rest: the slide steps in while the insert is on its far side."""
    turn = np.linspace(0.0, 2.0 * math.pi, 721)
    tool, x = [], []
    depth = 0.0
    for number, step in enumerate(STEPS):
        tool.append(turn[:-1] + 2.0 * math.pi * number + math.pi)
        x.append(np.full(720, 40.0 - depth - step))
        x[-1][:60] += step * (1.0 - np.clip(np.linspace(0.0, 1.2, 60), 0.0, 1.0))
        depth += step
    n = 720 * len(STEPS)
    motion = CutterMotion(
        time_s=np.linspace(1e-3, 1e-3 * n, n),
        work_angle=np.zeros(n),
        tool_angle=np.concatenate(tool),
        centre=np.column_stack([np.concatenate(x), np.zeros(n), np.full(n, -1.5)]),
        basis=synthetic.tool_basis(0.0),
    )
    return FLY.cutter(), motion


@pytest.mark.parametrize(
    ("name", "thickness", "expected"),
    [
        # k_c1.1 h^-m_c by hand: 0.1^-0.26 = 1.81970, 0.25^-0.26 = 1.43396, 0.1^-0.14 = 1.38038
        ("16MnCr5", 1.0, 2100.0),
        ("16MnCr5", 0.1, 3821.37),
        ("42CrMo4", 0.25, 3584.89),
        ("C45", 0.1, 3064.45),
    ],
)
def test_specific_force_by_hand(name, thickness, expected):
    (found,) = MATERIALS[name].specific_force(np.array([thickness]))
    assert found == pytest.approx(expected, rel=1e-5)


def test_metal_of_each_turn_is_the_crescent_between_two_circles(fly):
    metal = metal_of(BAR, fly, 0.125)
    depth = np.cumsum(STEPS)
    areas = np.diff([0.0, *(lens(d) for d in depth)])
    found = np.bincount(metal.index, metal.volume_mm3)
    np.testing.assert_allclose(found[found > 0], 2.0 * areas, rtol=0.01)
    assert (np.diff(metal.time_s, axis=1) > 0).all()


def test_energy_of_a_crescent_is_that_of_its_thickness(fly):
    """∫ k_c1.1 h^(−m_c) dA over the last crescent, h from the new circle to the old one or the bar, along the
    tool's radii: in polar coordinates about the tool. Rays are not along these, where they leave the bar."""
    metal = metal_of(BAR, fly, 0.1)
    last = metal.of(metal.index == metal.index.max())
    away = 40.0 - float(np.sum(STEPS))
    angle = np.linspace(-0.3, 0.3, 20001)
    middle = 0.5 * (angle[1:] + angle[:-1])
    near = []
    # the old circle stands STEPS[-1] further off, the bar's middle `away`, along angle 0
    for off, radius, far in ((-STEPS[-1], 30.0, True), (away, 10.0, False)):
        across = off * np.sin(middle)
        half = np.sqrt(np.maximum(radius * radius - across * across, 0.0))
        near.append(off * np.cos(middle) + (half if far else -half))
    thick = 30.0 - np.maximum(*near)
    meets = (thick > 0.0) & (np.abs(away * np.sin(middle)) < 10.0)
    energy = 2100.0 * thick[meets] ** -0.26 * (30.0 * thick[meets] - 0.5 * thick[meets] ** 2)
    wanted = 2.0 * energy.sum() * (angle[1] - angle[0])
    found = (Material(k_c11=2100.0, m_c=0.26).specific_force(last.thickness_mm) * last.volume_mm3).sum()
    assert found == pytest.approx(wanted, rel=0.02)


def test_force_is_kienzle_s_on_the_insert_and_opposes_its_way(fly, tmp_path):
    """In the middle of the last crescent the chip is as thick as the step, 2 mm wide. The force acts in the
    middle of its thickness."""
    _, motion = fly
    metal = metal_of(BAR, fly, 0.1)
    material = Material(k_c11=2100.0, m_c=0.26)
    load = cutting_load(
        metal,
        motion,
        kinematics=Polygon(tmp_path, physics="").ready.tools[0].kinematics,
        material=material,
        physics=Physics(feed_force_ratio=0.0, passive_force_ratio=0.4),
        compliance_um_per_n=0.0,
        clock=Clock(tick_s=1e-3, tick=np.arange(2880), tool_angle_deg=np.degrees(motion.tool_angle)),
    ).load.whole()
    middle = np.abs(load.tick - 2520) < 12
    radius = 30.0 - STEPS[-1] / 2.0
    speed = radius * 2.0 * math.pi / 0.72
    force = load.power_w[middle].mean() / (speed * 1e-3)
    assert force == pytest.approx(2100.0 * STEPS[-1] ** -0.26 * 2.0 * STEPS[-1], rel=0.02)
    # tool angle 0 looks along -X and the insert goes by towards -Y: the metal pushes it to +Y, and back to +X
    np.testing.assert_allclose(load.tool[middle].mean(axis=0), [0.4 * force, force, 0.0], atol=0.03 * force)
    # torque against its turn: force times the insert's radius
    assert load.axes[middle, 2].mean() == pytest.approx(-1e-3 * radius * force, rel=0.02)


def test_energy_of_the_metal_is_the_work_of_the_axes(tmp_path):
    """Virtual work: with axes that keep their speed the sums agree to rounding."""
    polygon = Polygon(tmp_path, physics="cutting_load = true")
    session = polygon.run()
    ready, recording = polygon.ready, session.recording
    (tool,) = session.motions
    metal = metal_of(polygon.job.work.blank(), tool, 0.3)
    clock = clock_of(recording)
    load = cutting_load(
        metal,
        tool[1],
        kinematics=ready.tools[0].kinematics,
        material=MATERIALS["16MnCr5"],
        physics=polygon.job.physics,
        compliance_um_per_n=0.0,
        clock=clock,
    ).load.whole()
    row = np.searchsorted(clock.tick, load.tick)
    turns = [k in (ready.work_column, ready.tool_column) for k in range(4)]
    way = (recording.actual[row] - recording.actual[row - 1]) * np.where(turns, math.pi / 180.0, 1e-3)
    energy = (MATERIALS["16MnCr5"].specific_force(metal.thickness_mm) * metal.volume_mm3).sum() * 1e-3
    assert load.power_w.sum() * clock.tick_s == pytest.approx(energy, rel=1e-9)
    assert -(load.axes * way).sum() == pytest.approx(energy, rel=1e-4)
    # it brakes the tool, pushes it off the work, and pays with nothing else
    tool = -(load.axes * way)[:, ready.tool_column].sum()
    assert tool > 0.7 * energy
    assert load.axes[:, 0].mean() > 0


def test_metal_is_what_the_part_has_lost(tmp_path):
    session = (polygon := Polygon(tmp_path, physics="cutting_load = true")).run()
    blank = polygon.job.work.blank()
    part = cut(blank, session.motions, cell_mm=0.2).remains
    metal = metal_of(blank, session.motions[0], 0.15)
    lost = part.blank_volume_mm3 - part.volume_mm3
    assert metal.volume_mm3.sum() == pytest.approx(lost, rel=0.01)


def test_rounds_settle_and_the_mounts_give_way_by_force_over_stiffness(tmp_path):
    physics = "cutting_load = true\nload_resolution_mm = 0.3\ntool_stiffness_n_per_um = 50.0\nk_c11 = 1000.0"
    polygon = Polygon(tmp_path, physics=physics)
    loaded = polygon.loaded()
    assert loaded.settled
    assert 2 <= loaded.rounds <= MOST_ROUNDS
    assert loaded.moved_um[-1] < 0.1
    assert all(b < a for a, b in zip(loaded.moved_um, loaded.moved_um[1:], strict=False))
    assert loaded.windows > 1
    before, after = polygon.run().motions[0][1], loaded.session.motions[0][1]
    pushed = loaded.session.recording.load
    assert pushed is not None
    np.testing.assert_allclose(1e3 * (after.centre - before.centre), pushed.deflection_um, atol=1e-9)
    # halfway between the forces of two ticks, on two springs in a row
    tick = loaded.load.tick[len(loaded.load.tick) // 2]
    row = int(np.searchsorted(clock_of(loaded.session.recording).tick, tick))
    at = np.searchsorted(loaded.load.tick, tick)
    force = loaded.load.tool[at : at + 2].mean(axis=0)
    np.testing.assert_allclose(pushed.deflection_um[row], force * (1 / 50.0 + 1 / 60.0), rtol=1e-9)
    figures = load_figures(loaded)["cutting_load"]
    assert isinstance(figures, dict)
    assert figures["energy_j"] == pytest.approx(loaded.load.power_w.sum() * 1e-3)


SOFT = "cutting_load = true\nload_resolution_mm = 0.4\nk_c11 = 500.0\ntool_stiffness_n_per_um = {}"


def test_a_mount_softer_than_the_chip_gives_way_and_cuts_less_by_the_pass(tmp_path):
    """Springs without mass push no edge into the metal, however soft: the cut settles, gives way by more than
    its chip is thick, and what stays meets the next insert."""
    stiff, soft = (Polygon(tmp_path, physics=SOFT.format(k)).loaded() for k in (100.0, 2.0))
    assert stiff.settled
    assert soft.settled
    figures = [load_figures(one)["cutting_load"] for one in (stiff, soft)]
    give, removed = ([one[key] for one in figures] for key in ("largest_deflection_um", "removed_mm3"))  # pyright: ignore[reportIndexIssue]
    assert give[0] < 50.0
    assert give[1] > 100.0
    assert removed[1] < 0.9 * removed[0]


def test_rounds_that_do_not_settle_are_a_finding_with_a_frequency(tmp_path):
    """A mount that gives way by half a millimetre: eight rounds of a single tick do not do."""
    loaded = Polygon(tmp_path, physics=SOFT.format(0.2)).loaded()
    assert not loaded.settled
    assert loaded.rounds == MOST_ROUNDS
    assert loaded.moved_um[-1] > SETTLED_UM
    # of the cut itself, not of the silence before it
    assert loaded.frequency_hz
    assert loaded.frequency_hz > 0.9 / (1e-3 * (loaded.load.tick[-1] - loaded.load.tick[0] + 1))
    (alarm,) = loaded.session.alarms
    assert alarm.number == "HT9040"
    assert "Hz" in alarm.found
    assert alarm.span
    assert alarm.span.line == 5


@pytest.mark.parametrize(
    ("torque", "k_c11", "stalls"), [(7.5, 2220, True), (40, 2220, True), (40, 250, False)]
)
def test_a_tool_stalls_where_metal_takes_more_than_drive_and_momentum_have(tmp_path, torque, k_c11, stalls):
    """While an insert crosses the metal its drive gives torque · angle, the spindle ½ J ω², at most.

    Where the metal takes more, the tool must stall; where it takes less than the drive gives, it must not.
    """
    drive = f"[machine.drives.tool_spindle]\ntorque_limit = {torque}"
    physics = f"cutting_load = true\nload_resolution_mm = 0.3\nk_c11 = {k_c11}\n{drive}"
    polygon = Polygon(tmp_path, physics=physics)
    free = polygon.loaded(ideal=True)
    tool, load = polygon.ready.tool_column, free.load
    turn = math.radians(3.6)  # per tick at 600 rpm, which ideal axes keep
    chips = np.split(np.arange(len(load.cell)), np.flatnonzero(np.diff(load.cell) > 5) + 1)
    energy = np.array([np.abs(load.axes[rows, tool]).sum() * turn for rows in chips])
    given = torque * turn * np.array([len(rows) for rows in chips])
    momentum = 0.5 * float(polygon.ready.driven.inertia()[tool, tool]) * (turn / 1e-3) ** 2
    assert (energy > given + momentum).any() == stalls
    assert (energy < given).all() != stalls
    loaded = polygon.loaded(ideal=False)
    assert loaded.stalled == stalls
    assert [alarm.number for alarm in loaded.session.alarms] == ["HT9041"] * stalls
    if stalls:
        (alarm,) = loaded.session.alarms
        assert f"its drive has {torque:g} N m" in alarm.found
        assert "of this feed" in alarm.found


@pytest.mark.parametrize("ideal", [True, False])
def test_no_metal_changes_not_a_bit(tmp_path, ideal):
    polygon = Polygon(tmp_path, physics="cutting_load = true\nload_resolution_mm = 0.5", x=22.0)
    loaded = polygon.loaded(ideal=ideal)
    assert loaded.settled
    assert (loaded.rounds, len(loaded.load.tick)) == (1, 0)
    plain = polygon.run(ideal=ideal)
    pressed = polygon.run(replace(loaded.load), ideal=ideal)
    for session in (loaded.session, pressed):
        assert np.array_equal(session.recording.actual, plain.recording.actual)
        assert np.array_equal(session.motions[0][1].centre, plain.motions[0][1].centre)
    assert load_figures(loaded)["cutting_load"]["removed_mm3"] == 0.0  # pyright: ignore[reportIndexIssue]


def test_unknown_materials_need_figures_of_their_own(tmp_path):
    with pytest.raises(InputError, match="no cutting forces are known of material 'cheese'") as raised:
        material_of("cheese", Physics())
    assert raised.value.remedy == "valid: 16MnCr5, 42CrMo4, C45; or k_c11 and m_c in [physics]"
    own = material_of("cheese", Physics(k_c11=800.0, m_c=0.2))
    assert (own.k_c11, own.m_c) == (800.0, 0.2)
    assert material_of("C45", Physics(m_c=0.2)) == Material(k_c11=2220.0, m_c=0.2)
    with pytest.raises(InputError, match="material 'cheese'") as raised:
        Polygon(tmp_path, physics="cutting_load = true", material="cheese")
    assert raised.value.place
    assert raised.value.place.line == 8
    Polygon(tmp_path, physics="cutting_load = false", material="cheese")


@pytest.mark.parametrize(
    ("tool", "size", "physics", "said"),
    [
        (
            "disc_wheel",
            "outside_diameter_mm = 80.0\nnormal_module_mm = 2.0",
            "cutting_load = true",
            "grinding wheel are not modelled",
        ),
        ("polygon_head", HEAD, "k_c11 = 0.0", "k_c11"),
        ("polygon_head", HEAD, "m_c = 1.0", "m_c"),
        ("polygon_head", HEAD, "tool_stiffness_n_per_um = -1.0", "tool_stiffness_n_per_um"),
        ("polygon_head", HEAD, "stiffness = 1.0", "unknown key 'stiffness'"),
        ("polygon_head", HEAD, 'cutting_load = "yes"', "cutting_load"),
    ],
)
def test_tables_that_cannot_be_are_refused_with_their_line(tmp_path, tool, size, physics, said):
    (tmp_path / "program.nc").write_text(PROGRAM.format(x=18.0), encoding="utf-8")
    text = JOB.format(material="C45", tool=tool, size=size, physics=physics)
    (tmp_path / "job.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=said) as raised:
        read_job(tmp_path)
    assert raised.value.place
    assert raised.value.place.line
    assert raised.value.exit_code is ExitCode.USAGE


def test_a_blank_that_is_cut_already_is_refused(tmp_path):
    (tmp_path / "program.nc").write_text(PROGRAM.format(x=18.0), encoding="utf-8")
    text = JOB.format(material="C45", tool="polygon_head", size=HEAD, physics="cutting_load = true")
    gear = (
        "[work.gear]\nstock_per_flank_mm = 0.1\nhelix_angle_deg = 0.0\nnormal_pressure_angle_deg = 20.0\n"
        "profile_shift = 0.0\ndedendum_factor = 1.25\nnumber_of_teeth = 10\nnormal_module_mm = 1.5\n[tool]"
    )
    (tmp_path / "job.toml").write_text(text.replace("[tool]", gear), encoding="utf-8")
    with pytest.raises(InputError, match="cut already are not modelled") as raised:
        read_job(tmp_path)
    assert raised.value.place
    assert (
        raised.value.place.line == text.replace("[tool]", gear).splitlines().index("cutting_load = true") + 1
    )


def test_rays_too_close_for_the_memory_are_refused(fly):
    with pytest.raises(InputError, match="more memory than allowed"):
        metal_of(BAR, fly, 1e-3)
