"""The machine's files and what is mounted on it: scene, parameter file, masses, refusals."""

import math
import re
import shutil
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest

from twin.errors import InputError
from twin.machine import (
    Assembly,
    MachineSpec,
    MachineZero,
    MujocoMachine,
    Setup,
    ToolMount,
    WorkMount,
    assemble,
    load_machine,
)
from twin.machine.spec import MODELS

HOB = ToolMount(carrier_swivel_deg=90.0, radius_mm=35.0, length_mm=80.0, edges=12)
BLANK = WorkMount(diameter_mm=44.0, length_mm=20.0, arbor_diameter_mm=21.0)


def mounted(setup: Setup = Setup.HOBBING, **changes: WorkMount | ToolMount | MachineZero) -> Assembly:
    return assemble(load_machine("hobbing_lathe"), setup, **({"work": BLANK, "tool": HOB} | changes))


@pytest.mark.parametrize("file", ["hobbing_lathe.xml", "scene.xml"])
def test_model_runs_a_second_under_noise_without_warnings(file: str) -> None:
    model = mujoco.MjModel.from_xml_path(str(MODELS / "hobbing_lathe" / file))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("home").id)
    rng = np.random.default_rng(0)
    moved = np.zeros(model.nq)
    while data.time < 1.0:
        data.ctrl = 0.1 * rng.standard_normal(model.nu) * model.actuator_ctrlrange[:, 1]
        mujoco.mj_step(model, data)
        moved = np.maximum(moved, np.abs(data.qpos))
    assert not any(w.number for w in data.warning)
    assert np.isfinite(data.qpos).all()
    assert (moved > 1e-4).all(), "every joint is driven"


@pytest.mark.parametrize("setup", Setup)
def test_mounted_machine_and_its_picture_share_their_state(setup: Setup) -> None:
    assembly = mounted(setup)
    seen = assembly.picture_model()
    assert [seen.joint(k).name for k in range(seen.njnt)] == [
        assembly.model.joint(k).name for k in range(assembly.model.njnt)
    ]
    assert sorted(assembly.joints) == sorted(seen.joint(k).name for k in range(seen.njnt))
    assert ("tilted_slide" in assembly.joints) == (setup is Setup.TILTED)
    np.testing.assert_array_equal(seen.key("home").qpos, np.zeros(len(assembly.joints)))
    assert seen.ngeom > assembly.model.ngeom
    np.testing.assert_allclose(seen.body_mass[seen.body("cutter").id], assembly.model.body("cutter").mass)


def test_axes_stand_in_the_order_of_the_set_ups() -> None:
    """controller.md, section 0: hobbing X, Z, Y = tool spindle, C; tilted X, Z, Y = tilted slide, C, B."""
    setups = load_machine("hobbing_lathe").setups
    assert setups[Setup.HOBBING] == ("x_slide", "z_slide", "tool_spindle", "work_spindle")
    assert setups[Setup.TILTED] == ("x_slide", "z_slide", "tilted_slide", "work_spindle", "tool_spindle")


def test_inertia_is_that_of_the_mounted_bodies() -> None:
    """Sum of masses on slides, rotors through 10 mm screws, ½ m r² on spindles, and sin θ m between the X
    and the tilted slide."""
    pitch = math.tau / 0.010
    steel = 7850.0
    hob = steel * math.pi * 0.035**2 * 0.080
    carried = 60.0 + 40.0 + 1.2 + hob
    blank = steel * math.pi * 0.022**2 * 0.020
    arbor = steel * math.pi * 0.0105**2 * 0.080
    expected = np.diag(
        [
            2.5e-4 * pitch**2 + 120.0 + carried,
            3.0e-4 * pitch**2 + 150.0 + 120.0 + carried,
            1.5e-4 * pitch**2 + carried,
            0.05 + 0.09 + blank * 0.022**2 / 2 + arbor * 0.0105**2 / 2,
            0.003 + 0.00035 + hob * 0.035**2 / 2,
        ]
    )
    expected[0, 2] = expected[2, 0] = -0.5 * carried
    np.testing.assert_allclose(mounted(Setup.TILTED).inertia(), expected, rtol=1e-9, atol=1e-9)


def test_inertia_does_not_depend_on_where_the_axes_stand() -> None:
    assembly = mounted(Setup.TILTED)
    data = mujoco.MjData(assembly.model)
    data.qpos = np.random.default_rng(5).uniform(-0.3, 0.3, assembly.model.nq)
    mujoco.mj_forward(assembly.model, data)
    full = np.zeros((5, 5))
    mujoco.mj_fullM(assembly.model, data, full)
    dofs = [assembly.model.joint(j).dofadr[0] for j in assembly.joints]
    np.testing.assert_allclose(full[np.ix_(dofs, dofs)], assembly.inertia(), rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"work": replace(BLANK, diameter_mm=0.0)}, "work diameter 0: must be above 0"),
        ({"work": replace(BLANK, length_mm=-1.0)}, "work length -1: must be above 0"),
        ({"work": replace(BLANK, arbor_diameter_mm=math.nan)}, "arbor diameter nan: must be above 0"),
        ({"work": replace(BLANK, stick_out_mm=math.inf)}, "stick-out inf: must be above 0 and finite"),
        (
            {"work": replace(BLANK, stick_out_mm=15.0)},
            "stick-out 15 mm: work 20 mm long would reach into the chuck",
        ),
        ({"tool": replace(HOB, radius_mm=0.0)}, "tool radius 0: must be above 0"),
        ({"tool": replace(HOB, edges=0)}, "number of cutting edges 0: must be above 0"),
        ({"tool": replace(HOB, carrier_swivel_deg=math.inf)}, "swivel of the set-up is inf"),
        ({"zero": MachineZero(x_mm=math.nan)}, "X of the set-up is nan"),
    ],
)
def test_impossible_mounts_are_refused(changes: dict, message: str) -> None:
    with pytest.raises(InputError, match=re.escape(message)):
        mounted(**changes)


def test_work_chucked_without_an_arbor_between() -> None:
    """Stick-out equal to the length: the blank starts in the chuck's face, and no arbor shows."""
    assembly = mounted(work=replace(BLANK, stick_out_mm=20.0))
    blank = 7850.0 * math.pi * 0.022**2 * 0.020
    np.testing.assert_allclose(assembly.model.body("blank").mass, blank, rtol=1e-12)


def edited(tmp_path: Path, *edits: tuple[str, str], file: str = "machine.toml") -> Path:
    """A copy of the models with exact replacements made in one file."""
    models = tmp_path / "models"
    shutil.copytree(MODELS, models, ignore=shutil.ignore_patterns("__pycache__"))
    path = models / "hobbing_lathe" / file
    text = path.read_text(encoding="utf-8")
    for old, new in edits:
        assert old in text
        text = text.replace(old, new, 1)
    path.write_text(text, encoding="utf-8")
    return models


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "motor_inertia = 2.5e-4",
            "motor_inertia = -1.0",
            "drives.x_slide: motor_inertia = -1.0 must not be",
        ),
        ("torque_limit = 12.7", "torque_limit = 0", "drives.x_slide: torque_limit = 0: must be above 0"),
        (
            "position_gain = 70.0",
            "position_gain = 'high'",
            "position_gain = 'high': expected a finite number",
        ),
        ("position_gain = 70.0", "position_gain = nan", "position_gain = nan: expected a finite number"),
        ("position_gain = 70.0", "position_gain = true", "position_gain = True: expected a finite number"),
        (
            "position_gain = 70.0",
            "kv = 70.0",
            "unknown key 'kv' (valid: kind, travel_per_turn, motor_inertia",
        ),
        ("in_position = 0.005 ", "# ", "drives.x_slide: key 'in_position' is missing"),
        ("work_stiffness = 60.0", "work_stiffness = 0.0", "mounts: work_stiffness = 0: must be above 0"),
        ("work_stiffness = 60.0", "stiffness = 60.0", "mounts: unknown key 'stiffness'"),
        ("physics_step_s = 0.001", "physics_step_s = 0.0003", "is 3.33333 physics steps of 0.0003 s"),
        ("physics_step_s = 0.001", "physics_step_s = 0.003", "is 0.333333 physics steps of 0.003 s"),
        ("physics_step_s = 0.001", "physics_step_s = 0.0", "machine: physics_step_s = 0: must be above 0"),
        (
            "[drives.tool_spindle]",
            "[drives.turret]",
            "set-up 'hobbing' moves 'tool_spindle', which has no drive",
        ),
        ('hobbing = ["x_slide", ', 'hobbing = ["z_slide", ', "setups.hobbing: a joint is named twice"),
        ('hobbing = ["x_slide", ', "hobbing = [3, ", "setups.hobbing: expected a list of joint names"),
        ("[setups]", "[setups", "cannot read machine parameters"),
    ],
)
def test_bad_parameter_files_are_refused_by_name(tmp_path: Path, old: str, new: str, message: str) -> None:
    with pytest.raises(InputError, match=re.escape(message)) as refusal:
        load_machine("hobbing_lathe", models=edited(tmp_path, (old, new)))
    assert "machine.toml: error:" in str(refusal.value)


def test_unknown_models_are_answered_with_the_known_ones() -> None:
    for name in ("lathe", "", "../models/hobbing_lathe", "hobbing_lathe/"):
        with pytest.raises(InputError, match=r"no machine model named .*valid: hobbing_lathe"):
            load_machine(name)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('<inertial mass="40"', '<inertial mass="-5"', "body 'carrier' has a mass of -5 kg"),
        ('<inertial mass="2600"', '<inertial mass="0"', "body 'bed' has a mass of 0 kg"),
        ('<joint name="x_slide"', '<joint name="cross_slide"', "has no joint named 'x_slide' .it has: work_"),
        (
            '<motor name="x_slide"',
            '<motor name="x_motor"',
            "has no actuator named 'x_slide' .it has: x_motor, z_slide",
        ),
        ('<body name="carrier"', '<body name="head"', "has no body named 'carrier'"),
        ('<key name="home"', '<key name="start"', "has no keyframe named 'home' .it has: start"),
        ('mass="150"', 'mass="0"', "body 'z_slide' has a mass of 0 kg"),
        ('diaginertia="4 14 11"', 'diaginertia="4 14 40"', "does not compile"),
        ("<worldbody>", "<worldbody", "cannot read machine model"),
    ],
)
def test_broken_models_are_refused(tmp_path: Path, old: str, new: str, message: str) -> None:
    models = edited(tmp_path, (old, new), file="hobbing_lathe.xml")
    with pytest.raises(InputError, match=message):
        assemble(load_machine("hobbing_lathe", models=models), Setup.HOBBING, work=BLANK, tool=HOB)


def test_a_machine_from_another_folder_runs(tmp_path: Path) -> None:
    """The folder is data: a copy with a finer physics step is another machine."""
    models = edited(tmp_path, ("physics_step_s = 0.001", "physics_step_s = 0.00025"))
    spec: MachineSpec = load_machine("hobbing_lathe", models=models)
    assert spec.substeps == 4
    machine = MujocoMachine(assemble(spec, Setup.HOBBING, work=BLANK, tool=HOB))
    assert machine.assembly.model.opt.timestep == 0.00025
