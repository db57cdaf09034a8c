"""Work and tool offsets as the operator has set them, in programmed units (a diameter axis in diameter)."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from controller.alarms import ControllerError
from controller.codes import G_CODES, Group, g_name
from controller.machine_data import MachineData

LAST_TOOL_OFFSET = 99
WORK_OFFSETS = tuple(g_name(code.tenths) for code in G_CODES.values() if code.group is Group.WORK_OFFSET)


@dataclass(frozen=True, slots=True, kw_only=True)
class Offsets:
    """Preset offsets; what is not named is zero."""

    work: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    """"G54" … "G59" -> axis letter -> machine coordinate of the part zero"""
    tool: Mapping[int, Mapping[str, float]] = field(default_factory=dict)
    """offset number 1 … 99 -> axis letter -> offset"""
    mounted: Mapping[str, float] = field(default_factory=dict)
    """offset of the tool that is mounted without a T word, in force until the first T"""

    def of_work(self, tenths: int, machine: MachineData) -> dict[int, float]:
        """Column -> slide travel [mm | deg] of a work offset, G code in tenths."""
        return _columns(self.work.get(g_name(tenths), {}), machine)

    def of_tool(self, number: int | None, machine: MachineData) -> dict[int, float]:
        """Column -> slide travel [mm | deg] of a tool offset; None = of the mounted tool."""
        return _columns(self.mounted if number is None else self.tool.get(number, {}), machine)

    def check(self, machine: MachineData) -> None:
        """Raise ControllerError for offsets that this machine does not have."""
        for name in self.work:
            if name not in WORK_OFFSETS:
                raise ControllerError(f"unknown work offset {name!r}", remedy=", ".join(WORK_OFFSETS))
        for number in self.tool:
            if not 1 <= number <= LAST_TOOL_OFFSET:
                raise ControllerError(f"tool offset {number} out of range", remedy=f"1 to {LAST_TOOL_OFFSET}")
        for values in (*self.work.values(), *self.tool.values(), self.mounted):
            for letter in values:
                if letter not in machine.letters:
                    raise ControllerError(
                        f"offset of unknown axis {letter!r}", remedy=", ".join(machine.letters)
                    )


def _columns(values: Mapping[str, float], machine: MachineData) -> dict[int, float]:
    axes = {axis.letter: (k, axis.factor) for k, axis in enumerate(machine.axes)}
    return {axes[letter][0]: value / axes[letter][1] for letter, value in values.items()}
