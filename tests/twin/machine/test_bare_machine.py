"""What the drives step against the whole machine in MuJoCo, under the same forces."""

# pyright: reportAttributeAccessIssue=false

import mujoco
import numpy as np
import pytest
from mounted import DELIVERED

from twin.machine import Assembly, Setup, ToolMount, WorkMount, assemble


def mounted(setup: Setup, swivel: float = 87.3) -> Assembly:
    return assemble(
        DELIVERED,
        setup,
        work=WorkMount(diameter_mm=44.0, length_mm=20.0, arbor_diameter_mm=21.0),
        tool=ToolMount(carrier_swivel_deg=swivel, radius_mm=35.0, length_mm=80.0, edges=12),
    )


def moved(model: mujoco.MjModel, noise: np.ndarray) -> np.ndarray:
    """(n, joints) positions under (n, actuators) shares of the motors' limits."""
    data, path = mujoco.MjData(model), []
    for row in noise:
        data.ctrl[:] = row * model.actuator_ctrlrange[:, 1]
        mujoco.mj_step(model, data)
        path.append(data.qpos.copy())
    return np.array(path)


@pytest.mark.parametrize("setup", Setup)
def test_joints_alone_move_as_the_whole_machine_does(setup: Setup) -> None:
    """Through friction, reversals and the coupling of the inclined slide, spindles turned by some radians."""
    assembly = mounted(setup)
    alone, whole = assembly.joints_alone, assembly.model
    names = [[m.joint(k).name for k in range(m.njnt)] for m in (alone, whole)]
    assert names[0] == names[1]
    noise = np.random.default_rng(8).normal(scale=0.2, size=(3000, whole.nu))
    path = moved(whole, noise)
    far = np.abs(path).max(axis=0)
    assert (far > 1e-3).all()
    assert (np.abs(moved(alone, noise) - path) <= 1e-13 * far).all()


@pytest.mark.parametrize("setup", Setup)
def test_joints_alone_carry_the_same_inertia(setup: Setup) -> None:
    assembly = mounted(setup)
    full = []
    for model in (assembly.joints_alone, assembly.model):
        data, matrix = mujoco.MjData(model), np.zeros((model.nv, model.nv))
        data.qpos[:] = 0.1
        mujoco.mj_forward(model, data)
        mujoco.mj_fullM(model, data, matrix)
        full.append(matrix)
    np.testing.assert_allclose(full[0], full[1], rtol=1e-13, atol=1e-13)
    assert (assembly.joints_alone.ngeom, assembly.joints_alone.nmesh) == (0, 0)
