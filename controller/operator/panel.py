"""The operator's panel: modes, switches, overrides, signals, and whether the program runs."""

from dataclasses import dataclass
from enum import Enum

from controller.operator.actions import OperatorAction, OperatorEvent
from controller.tables.signals import AxisInput, Inputs


class Mode(Enum):
    """What the panel commands."""

    AUTO = "auto"
    MANUAL = "manual"


@dataclass(slots=True, kw_only=True)
class Panel:
    """The state of the panel. A program begins as if cycle start had been pressed at time zero."""

    inputs: Inputs
    levels: dict[str, bool]
    """the levels of `inputs` for whoever reads blocks: optional stop and block skip are signals"""
    mode: Mode = Mode.AUTO
    running: bool = True
    """cycle start; False in a hold, at a stop, between single blocks, after the end"""
    single_block: bool = False
    feed_override: float = 1.0
    rapid_override: float = 1.0
    """1, 0.5, 0.25, or 0 = F0"""
    spindle_override: float = 1.0
    locked: bool = False
    """machine lock of all axes"""
    dry_run: bool = False
    emergency: bool = False
    """until RESET"""

    @classmethod
    def of(cls, inputs: Inputs) -> "Panel":
        """As at power-on, with these signals."""
        return cls(inputs=inputs, levels=dict(inputs.levels))

    def set_signal(self, name: str, level: bool) -> None:
        """An input signal changes."""
        self.inputs = self.inputs.changed(name, level)
        self.levels[name] = level

    def locked_columns(self, axes: int) -> frozenset[int]:
        """Columns under machine lock, as a whole or by MLKx."""
        return frozenset(range(axes)) if self.locked else self.inputs.columns(AxisInput.LOCK)

    def turn(self, event: OperatorEvent) -> bool:
        """Set what only the panel knows; False where the event asks for more than that."""
        match event.action:
            case OperatorAction.SINGLE_BLOCK:
                self.single_block = event.on
            case OperatorAction.OPTIONAL_STOP:
                self.set_signal("OPTIONAL_STOP", event.on)
            case OperatorAction.BLOCK_SKIP:
                self.set_signal(f"BDT{event.number}", event.on)
            case OperatorAction.FEED_OVERRIDE:
                self.feed_override = event.value / 100.0
            case OperatorAction.RAPID_OVERRIDE:
                self.rapid_override = event.value / 100.0
            case OperatorAction.DRY_RUN:
                self.dry_run = event.on
            case _:
                return False
        return True
