"""A mounted machine and motions for it, shared by the tests of drives."""

from dataclasses import replace

import numpy as np

from controller.clock import Chunk, Feedback, Follow, Load
from twin.machine import MachineSpec, MujocoMachine, Setup, ToolMount, WorkMount, assemble, load_machine

DELIVERED = load_machine("hobbing_lathe")
PERIOD = DELIVERED.control_period_s
X, Z, TOOL, WORK = range(4)


def changed(spec: MachineSpec, **values: object) -> MachineSpec:
    """The same change made to every drive."""
    return replace(spec, drives={j: replace(d, **values) for j, d in spec.drives.items()})  # pyright: ignore[reportArgumentType]


def changed_drive(spec: MachineSpec, joint: str, **values: object) -> MachineSpec:
    """A change made to one drive."""
    drive = replace(spec.drives[joint], **values)  # pyright: ignore[reportArgumentType]
    return replace(spec, drives={**spec.drives, joint: drive})


EXACT = changed(DELIVERED, encoder_counts=0.0)
"""with encoders that read every position exactly"""
FRICTIONLESS = changed(EXACT, coulomb_friction=0.0, viscous_friction=0.0)


def machine(spec: MachineSpec = DELIVERED, setup: Setup = Setup.HOBBING) -> MujocoMachine:
    """A hob over a blank."""
    return MujocoMachine(
        assemble(
            spec,
            setup,
            work=WorkMount(diameter_mm=44.0, length_mm=20.0, arbor_diameter_mm=21.0),
            tool=ToolMount(carrier_swivel_deg=90.0, radius_mm=35.0, length_mm=80.0, edges=12),
        )
    )


def move(
    on: MujocoMachine,
    setpoint: np.ndarray,
    *,
    first: int = 0,
    couplings: tuple[Follow, ...] = (),
    load: Load | None = None,
) -> Feedback:
    """One chunk of (n, axes) setpoints."""
    n = len(setpoint)
    chunk = Chunk(
        first_tick=first,
        setpoint=setpoint,
        block=np.zeros(n, np.int32),
        sync=np.zeros(n, np.bool_),
        tool=np.zeros(n, np.int16),
        couplings=couplings,
    )
    return on.advance(chunk, load)


def ramp(speed: float, acceleration: float, ticks: int) -> np.ndarray:
    """Position [unit] of an axis that accelerates from rest to `speed` [unit/s]."""
    t = np.arange(1, ticks + 1) * PERIOD
    reached = speed / acceleration
    return np.where(t < reached, acceleration * t**2 / 2, speed * (t - reached / 2))
