"""The lathe itself: MJCF, servo drives, encoders. Millimetres and degrees outside, SI inside."""

from twin.machine.assembly import (
    Assembly,
    MachineZero,
    ToolMount,
    WorkMount,
    assemble,
    hob_carrier_swivel,
)
from twin.machine.collisions import Guarded
from twin.machine.drive import Drive, DriveKind
from twin.machine.ideal import IdealMachine
from twin.machine.physical import MujocoMachine
from twin.machine.spec import Changes, MachineSpec, Setup, load_machine
from twin.machine.sync_window import SyncWindow
from twin.machine.tailstock import TailstockMount
from twin.machine.watching import MachineError

__all__ = [
    "Assembly",
    "Changes",
    "Drive",
    "DriveKind",
    "Guarded",
    "IdealMachine",
    "MachineError",
    "MachineSpec",
    "MachineZero",
    "MujocoMachine",
    "Setup",
    "SyncWindow",
    "TailstockMount",
    "ToolMount",
    "WorkMount",
    "assemble",
    "hob_carrier_swivel",
    "load_machine",
]
