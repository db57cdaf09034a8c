"""The chain against MuJoCo's own forward kinematics, and against the senses of controller.md, section 0."""

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from twin.kinematics import Kinematics, cutter_motion, part_frame, read_chain, read_kinematics, rotation_about
from twin.machine import (
    Assembly,
    MachineZero,
    Setup,
    ToolMount,
    WorkMount,
    assemble,
    hob_carrier_swivel,
    load_machine,
)

WORK = WorkMount(diameter_mm=44.0, length_mm=20.0, arbor_diameter_mm=21.0)


def mounted(
    setup: Setup, swivel_deg: float, *, zero: MachineZero | None = None, work: WorkMount = WORK
) -> Assembly:
    tool = ToolMount(carrier_swivel_deg=swivel_deg, radius_mm=35.0, length_mm=80.0, edges=12)
    return assemble(load_machine("hobbing_lathe"), setup, work=work, tool=tool, zero=zero)


def chains(assembly: Assembly) -> Kinematics:
    return read_kinematics(assembly.model, assembly.joints)


def random_axes(assembly: Assembly, rng: np.random.Generator, n: int) -> np.ndarray:
    """(n, k) slides within ±300 mm, spindles within ±1000 turns."""
    reach = [3.6e5 if "spindle" in j else 300.0 for j in assembly.joints]
    return rng.uniform(-1.0, 1.0, (n, len(reach))) * reach


@pytest.mark.parametrize("setup", Setup)
@pytest.mark.parametrize("swivel_deg", [0.0, 90.0, 61.3, -17.0])
def test_poses_agree_with_mujoco(setup: Setup, swivel_deg: float) -> None:
    assembly = mounted(setup, swivel_deg)
    kinematics = chains(assembly)
    axes = random_axes(assembly, np.random.default_rng(1), 50)
    model, data = assembly.model, mujoco.MjData(assembly.model)
    for chain, site in ((kinematics.tool, "tool_centre"), (kinematics.work, "front_face")):
        positions, rotations = chain.pose(axes)
        assert positions.shape == (50, 3)
        assert rotations.shape == (50, 3, 3)
        for row, position, rotation in zip(axes, positions, rotations, strict=True):
            for joint, value in zip(assembly.joints, row, strict=True):
                data.joint(joint).qpos[0] = np.radians(value) if "spindle" in joint else value * 1e-3
            mujoco.mj_forward(model, data)
            np.testing.assert_allclose(position * 1e-3, data.site(site).xpos, rtol=0, atol=1e-12)
            np.testing.assert_allclose(rotation, data.site(site).xmat.reshape(3, 3), rtol=0, atol=1e-12)


@pytest.mark.parametrize("setup", Setup)
def test_picture_and_physics_have_the_same_chain(setup: Setup) -> None:
    assembly = mounted(setup, 40.0)
    axes = random_axes(assembly, np.random.default_rng(2), 5)
    seen = read_kinematics(assembly.picture_model(), assembly.joints)
    for a, b in zip(chains(assembly).tool.pose(axes), seen.tool.pose(axes), strict=True):
        np.testing.assert_array_equal(a, b)


@pytest.mark.parametrize("stick_out_mm", [None, 150.0])
def test_machine_zero_puts_the_tip_on_the_reference(stick_out_mm: float | None) -> None:
    work = WorkMount(diameter_mm=44.0, length_mm=20.0, arbor_diameter_mm=21.0, stick_out_mm=stick_out_mm)
    assembly = mounted(Setup.HOBBING, 0.0, zero=MachineZero(x_mm=380.0, z_mm=290.0), work=work)
    motion = cutter_motion(chains(assembly), np.arange(2.0), np.zeros((2, 4)))
    np.testing.assert_allclose(motion.centre, 2 * [[380.0 / 2 + 35.0, 0.0, 290.0]], rtol=0, atol=1e-10)
    front, _ = chains(assembly).work.pose(np.zeros((1, 4)))
    np.testing.assert_allclose(front, [[0.0, 0.0, stick_out_mm or 100.0]], rtol=0, atol=1e-10)


@given(st.floats(-50.0, 50.0))
@settings(max_examples=10, deadline=None)
def test_hob_axis_stands_at_its_swivel(eta: float) -> None:
    kinematics = chains(mounted(Setup.HOBBING, hob_carrier_swivel(eta)))
    basis = cutter_motion(kinematics, np.arange(2.0), np.zeros((2, 4))).basis
    c, s = np.cos(np.radians(eta)), np.sin(np.radians(eta))
    expected = [[-1.0, 0.0, 0.0], np.cross([0.0, -c, s], [-1.0, 0.0, 0.0]), [0.0, -c, s]]
    np.testing.assert_allclose(basis, expected, rtol=0, atol=1e-14)


def test_polygon_head_stands_parallel_to_the_work() -> None:
    basis = cutter_motion(chains(mounted(Setup.HOBBING, 0.0)), np.arange(2.0), np.zeros((2, 4))).basis
    np.testing.assert_array_equal(basis, [[-1, 0, 0], [0, -1, 0], [0, 0, 1]])


@pytest.mark.parametrize(
    ("setup", "column", "direction"),
    [
        (Setup.HOBBING, 0, [1.0, 0.0, 0.0]),
        (Setup.HOBBING, 1, [0.0, 0.0, 1.0]),
        (Setup.TILTED, 0, [1.0, 0.0, 0.0]),
        (Setup.TILTED, 1, [0.0, 0.0, 1.0]),
        (Setup.TILTED, 2, [np.sin(np.radians(-30.0)), np.cos(np.radians(-30.0)), 0.0]),
    ],
)
def test_slides_move_the_tool_in_their_senses(setup: Setup, column: int, direction: list[float]) -> None:
    assembly = mounted(setup, 90.0)
    axes = np.zeros((2, len(assembly.joints)))
    axes[1, column] = 100.0
    centre = cutter_motion(chains(assembly), np.array([0.0, 1.0]), axes).centre
    np.testing.assert_allclose(centre[1] - centre[0], 100.0 * np.array(direction), rtol=0, atol=1e-10)


@pytest.mark.parametrize(("setup", "tool", "work"), [(Setup.HOBBING, 2, 3), (Setup.TILTED, 4, 3)])
def test_angles_are_those_of_the_spindles(setup: Setup, tool: int, work: int) -> None:
    assembly = mounted(setup, 70.0)
    axes = random_axes(assembly, np.random.default_rng(3), 20)
    motion = cutter_motion(chains(assembly), np.arange(20.0), axes)
    np.testing.assert_allclose(motion.tool_angle, np.radians(axes[:, tool]))
    np.testing.assert_allclose(motion.work_angle, np.radians(axes[:, work]))


@pytest.mark.parametrize("setup", Setup)
def test_part_frame_is_what_the_turning_part_sees(setup: Setup) -> None:
    """p_world = origin + Rz(C) p_part, with the tool's pose as MuJoCo has it."""
    assembly = mounted(setup, 55.0)
    axes = random_axes(assembly, np.random.default_rng(4), 20)
    model, data = assembly.model, mujoco.MjData(assembly.model)
    centres, tool_axes, zeros = part_frame(cutter_motion(chains(assembly), np.arange(20.0), axes))
    for row, centre, axis, zero in zip(axes, centres, tool_axes, zeros, strict=True):
        for joint, value in zip(assembly.joints, row, strict=True):
            data.joint(joint).qpos[0] = np.radians(value) if "spindle" in joint else value * 1e-3
        mujoco.mj_forward(model, data)
        c = np.radians(row[3])
        turned = np.array([[np.cos(c), -np.sin(c), 0], [np.sin(c), np.cos(c), 0], [0, 0, 1]])
        origin = np.array([0.0, 0.0, 100.0])
        np.testing.assert_allclose(origin + turned @ centre, data.site("tool_centre").xpos * 1e3, atol=1e-9)
        np.testing.assert_allclose(
            turned @ axis, data.site("tool_centre").xmat.reshape(3, 3)[:, 2], atol=1e-11
        )
        np.testing.assert_allclose(turned @ zero, [-1.0, 0.0, 0.0], atol=1e-11)


@given(st.floats(-7.0, 7.0), st.floats(-7.0, 7.0), st.tuples(*[st.floats(-1.0, 1.0)] * 3))
def test_rotations_form_a_group(a: float, b: float, direction: tuple[float, float, float]) -> None:
    if np.linalg.norm(direction) < 0.1:
        return
    axis = np.array(direction) / np.linalg.norm(direction)
    first, second, both = rotation_about(axis, np.array([a, b, a + b]))
    np.testing.assert_allclose(first @ second, both, atol=1e-14)
    np.testing.assert_allclose(first @ first.T, np.eye(3), atol=1e-14)
    np.testing.assert_allclose(first @ axis, axis, atol=1e-14)


def test_wrong_shapes_and_bodies_are_named() -> None:
    assembly = mounted(Setup.HOBBING, 0.0)
    with pytest.raises(ValueError, match=r"actual: expected \(2, 4\), got \(2, 5\)"):
        cutter_motion(chains(assembly), np.zeros(2), np.zeros((2, 5)))
    with pytest.raises(ValueError, match="no body 'tailstock'"):
        read_chain(assembly.model, "tailstock", assembly.joints)
    with pytest.raises(ValueError, match="joint 'x_slide': expected a slide or hinge from 0"):
        read_chain(assembly.model, "tool", ("z_slide", "tool_spindle", "work_spindle"))


@pytest.mark.parametrize(
    ("work", "message"),
    [
        ('<joint type="hinge" axis="1 0 0" name="c"/>', "a spindle about its own Z"),
        ('<joint type="slide" axis="0 0 1" name="c"/>', "work: expected one spindle"),
    ],
)
def test_a_machine_of_another_structure_is_refused(work: str, message: str) -> None:
    mass = '<inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>'
    model = mujoco.MjModel.from_xml_string(f"""
        <mujoco><worldbody>
          <body name="s">{mass}{work}<body name="work"/></body>
          <body name="tool">{mass}<joint name="b" axis="0 0 1"/></body>
        </worldbody></mujoco>""")
    with pytest.raises(ValueError, match=message):
        read_kinematics(model, ("b", "c"))
