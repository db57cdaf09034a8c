"""What the rules are shown: a command with its place in the stock, and a gear box that is about to cut."""

from dataclasses import dataclass

from controller.commands import Arc, Couple, Feed, MachineMove, Move, ReferenceReturn, Skip, Thread
from controller.laws.gearbox import GearBox, SyncKind
from controller.observed import Observed
from controller.span import Span
from twin.advice.scene import MountedTool
from twin.advice.stock import Floats


@dataclass(frozen=True, slots=True, kw_only=True)
class Engagement:
    """A gear box as it was engaged, and the tool that works in it."""

    couple: Couple
    span: Span
    """the block of G81 or G51.2"""
    mounted: MountedTool

    @property
    def gear(self) -> GearBox:
        """The gear box."""
        return self.couple.gear


@dataclass(frozen=True, slots=True, kw_only=True)
class Moment:
    """One command and what it does to the stock."""

    seen: Observed
    mounted: MountedTool
    reach: Floats
    """(n,) least radius that the tips come to at each place of the stock [mm]"""
    cut_depth: float
    """how deep they go into metal that is still there [mm]; 0 = they do not"""
    blank_depth: float
    """how deep they go under the surface of the whole blank [mm]"""

    @property
    def gear(self) -> GearBox | None:
        """The gear box in force."""
        return self.seen.gear

    @property
    def rapid(self) -> bool:
        """Whether the axes move at rapid."""
        command = self.seen.command
        return isinstance(command, MachineMove | ReferenceReturn) or (
            isinstance(command, Move) and command.feed is None
        )

    @property
    def feed(self) -> Feed | None:
        """The feed of a cutting move."""
        match self.seen.command:
            case Move(feed=feed) | Arc(feed=feed) | Skip(move=Move(feed=feed)):
                return feed
            case _:
                return None

    @property
    def moves(self) -> bool:
        """Whether the command moves axes along a path."""
        return self.rapid or self.feed is not None or isinstance(self.seen.command, Thread)

    @property
    def work_rpm(self) -> float:
        """Speed of the work in sync [rpm], without sign; 0 out of sync."""
        if self.gear is None:
            return 0.0
        ratio = self.gear.ratio if self.gear.kind is SyncKind.HOBBING else 1.0
        return abs(self.seen.master_rpm * ratio)
