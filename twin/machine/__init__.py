"""The lathe itself: MJCF, servo drives, encoders. Millimetres and degrees outside, SI inside."""

from twin.machine.assembly import (
    Assembly,
    MachineZero,
    ToolMount,
    WorkMount,
    assemble,
    hob_carrier_swivel,
)
from twin.machine.ideal import IdealMachine
from twin.machine.physical import MujocoMachine
from twin.machine.spec import Drive, MachineSpec, Setup, load_machine
from twin.machine.watching import MachineError

__all__ = [
    "Assembly",
    "Drive",
    "IdealMachine",
    "MachineError",
    "MachineSpec",
    "MachineZero",
    "MujocoMachine",
    "Setup",
    "ToolMount",
    "WorkMount",
    "assemble",
    "hob_carrier_swivel",
    "load_machine",
]
