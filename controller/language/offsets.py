"""Work and tool offsets, in programmed units (a diameter axis in diameter).

The operator presets them; G10 and the system variables change them. A tool offset is geometry plus wear.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from controller.tables.alarms import ControllerError
from controller.tables.codes import G_CODES, Group, g_name
from controller.tables.machine_data import MachineData

LAST_TOOL_OFFSET = 99
WORK_OFFSETS = tuple(g_name(code.tenths) for code in G_CODES.values() if code.group is Group.WORK_OFFSET)
Values = Mapping[str, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Offsets:
    """Offsets; what is not named is zero."""

    work: Mapping[str, Values] = field(default_factory=dict)
    """"G54" … "G59" -> axis letter -> machine coordinate of the part zero"""
    tool: Mapping[int, Values] = field(default_factory=dict)
    """offset number 1 … 99 -> axis letter -> offset (geometry)"""
    wear: Mapping[int, Values] = field(default_factory=dict)
    """offset number 1 … 99 -> axis letter -> wear, added to the geometry"""
    nose: Mapping[int, Values] = field(default_factory=dict)
    """offset number -> "R" nose radius, "Q" direction of the imaginary tip; for #2201, #2301"""
    mounted: Values = field(default_factory=dict)
    """offset of the tool that is mounted without a T word, in force until the first T"""

    def of_work(self, tenths: int, machine: MachineData) -> dict[int, float]:
        """Column -> slide travel [mm | deg] of a work offset, G code in tenths."""
        return _columns(self.work.get(g_name(tenths), {}), machine)

    def of_tool(self, number: int | None, machine: MachineData) -> dict[int, float]:
        """Column -> slide travel [mm | deg] of a tool offset; None = of the mounted tool."""
        if number is None:
            return _columns(self.mounted, machine)
        geometry, wear = self.tool.get(number, {}), self.wear.get(number, {})
        letters = dict.fromkeys([*geometry, *wear])
        return _columns({k: geometry.get(k, 0.0) + wear.get(k, 0.0) for k in letters}, machine)

    def moving_part(self, number: int, machine: MachineData) -> dict[int, float]:
        """The part of a tool offset that moves the axes: wear unless LWT, geometry if LGT (Fanuc 5002)."""
        parameters = machine.parameters
        wear = {} if parameters.bit(5002, 2) else _columns(self.wear.get(number, {}), machine)
        geometry = _columns(self.tool.get(number, {}), machine) if parameters.bit(5002, 4) else {}
        return {k: wear.get(k, 0.0) + geometry.get(k, 0.0) for k in {**wear, **geometry}}

    def with_work(self, tenths: int, letter: str, value: float) -> "Offsets":
        """The same with one value of a work offset changed."""
        name = g_name(tenths)
        return replace(self, work={**self.work, name: {**self.work.get(name, {}), letter: value}})

    def with_wear(self, number: int, letter: str, value: float) -> "Offsets":
        """The same with one wear value changed."""
        return replace(self, wear={**self.wear, number: {**self.wear.get(number, {}), letter: value}})

    def with_geometry(self, number: int, letter: str, value: float) -> "Offsets":
        """The same with one geometry value changed."""
        return replace(self, tool={**self.tool, number: {**self.tool.get(number, {}), letter: value}})

    def with_nose(self, number: int, letter: str, value: float) -> "Offsets":
        """The same with nose radius ("R") or tip direction ("Q") changed."""
        return replace(self, nose={**self.nose, number: {**self.nose.get(number, {}), letter: value}})

    def check(self, machine: MachineData) -> None:
        """Raise ControllerError for offsets that this machine does not have."""
        for name in self.work:
            if name not in WORK_OFFSETS:
                raise ControllerError(f"unknown work offset {name!r}", remedy=", ".join(WORK_OFFSETS))
        for number in (*self.tool, *self.wear):
            if not 1 <= number <= LAST_TOOL_OFFSET:
                raise ControllerError(f"tool offset {number} out of range", remedy=f"1 to {LAST_TOOL_OFFSET}")
        for values in (*self.work.values(), *self.tool.values(), *self.wear.values(), self.mounted):
            for letter in values:
                if letter not in machine.letters:
                    raise ControllerError(
                        f"offset of unknown axis {letter!r}", remedy=", ".join(machine.letters)
                    )


def _columns(values: Values, machine: MachineData) -> dict[int, float]:
    axes = {axis.letter: (k, axis.factor) for k, axis in enumerate(machine.axes)}
    return {axes[letter][0]: value / axes[letter][1] for letter, value in values.items()}
