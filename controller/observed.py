"""What one typed command has done: the record on which trace and advice are built."""

from dataclasses import dataclass

from controller.commands import Command
from controller.laws.gearbox import GearBox
from controller.span import Span


@dataclass(frozen=True, slots=True, kw_only=True)
class Observed:
    """A command that has been carried out. Axes by column, lengths in slide millimetres (a diameter axis in
    radius), angles in degrees, as in the command itself; times count from the start."""

    command: Command
    span: Span
    """the block it comes from"""
    start_s: float
    end_s: float
    absolute_before: tuple[float, ...]
    """(axes,) work coordinates"""
    absolute_after: tuple[float, ...]
    """(axes,)"""
    slides_before: tuple[float, ...]
    """(axes,) machine coordinates, rotary axes unwrapped"""
    slides_after: tuple[float, ...]
    """(axes,)"""
    gear: GearBox | None
    """the gear box in force when the command began"""
    master_rpm: float
    """speed that the master of `gear` has, or is heading for, when the command began [rpm]; 0 without"""
