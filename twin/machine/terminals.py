"""Where a drive is wired to the machine: MuJoCo's own memory, so that nothing is copied in a tick."""

# pyright: reportAttributeAccessIssue=false

from dataclasses import dataclass
from typing import cast

import mujoco  # its bindings are compiled and carry no types
import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Terminals:
    """One axis; each is a view of one float [m | rad, seconds, N | N m], read and written as `view[0]`."""

    position: "memoryview[float]"
    """of the motor, referred to the axis"""
    speed: "memoryview[float]"
    force: "memoryview[float]"
    """of the motor, over the coming period"""
    load: "memoryview[float]"
    """what the cut puts on the axis"""
    reading: "memoryview[float]"
    """what the encoder reads"""


def terminals(
    model: mujoco.MjModel, data: mujoco.MjData, joint: str, reading: "memoryview[float]"
) -> Terminals:
    """Of the joint, and of the actuator with its name."""
    hinge = model.joint(joint)
    position, dof, motor = int(hinge.qposadr[0]), int(hinge.dofadr[0]), model.actuator(joint).id
    return Terminals(
        position=view(data.qpos, position),
        speed=view(data.qvel, dof),
        force=view(data.ctrl, motor),
        load=view(data.qfrc_applied, dof),
        reading=reading,
    )


def view(array: NDArray[np.float64], at: int) -> "memoryview[float]":
    """One float of a (n,) array, in place."""
    return cast("memoryview[float]", array.data[at : at + 1])
