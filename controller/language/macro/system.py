"""System variables from #1000 on, of the controller that runs the program (Fanuc custom macro B, lathe).

Lengths are programmed units: inches under G20, a diameter axis in diameter. Axes count in system order. No
block is read ahead, so a position is that of the end of the block before.
"""

from collections.abc import Callable
from enum import Enum

from controller.language.macro.functions import Value
from controller.language.modal import Modal
from controller.language.offsets import WORK_OFFSETS, Offsets
from controller.laws.gearbox import MM_PER_INCH
from controller.motion.motion import Motion
from controller.motion.registers import modulo
from controller.tables.codes import G_CODES, Group, g_name
from controller.tables.machine_data import MachineData

LAST_USER_ALARM = 200
ALARM, MESSAGE_STOP = 3000, 3006
_MILLISECONDS, _HOURS = 3001, 3002
_SECONDS_PER = {_MILLISECONDS: 1e-3, _HOURS: 3600.0}
_FIRST_WORK_OFFSET, _WORK_STRIDE = 5221, 20


class _Memory(Enum):
    """Where a tool offset variable stands."""

    WEAR = "wear"
    GEOMETRY = "geometry"
    NOSE = "nose"


_TOOL_BASES = (
    (2000, _Memory.WEAR, "X"),
    (2100, _Memory.WEAR, "Z"),
    (2400, _Memory.WEAR, "Y"),
    (2700, _Memory.GEOMETRY, "X"),
    (2800, _Memory.GEOMETRY, "Z"),
    (2450, _Memory.GEOMETRY, "Y"),
    (2200, _Memory.NOSE, "R"),
    (2300, _Memory.NOSE, "Q"),
)
"""number of offset 0, what it is, letter"""
_MOST_OF_A_KIND = 64
_MOST_OF_Y = 49
_GROUP_OF = {4000 + int(group.value): group for group in Group if group is not Group.ONE_SHOT}
_POSITIONS = (5000, 5020, 5040, 5060, 5080)


class SystemVariables:
    """Reads and writes system variables of the machine it was last shown (`look`)."""

    def __init__(self, machine: MachineData, offsets: Offsets) -> None:
        self.offsets = offsets
        """as the program has changed them"""
        self._machine = machine
        self._motion: Motion | None = None
        self._modal = Modal()
        self._label: Callable[[], tuple[int | None, int | None]] = lambda: (None, None)
        self._started = {_MILLISECONDS: 0.0, _HOURS: 0.0}

    def look(self, motion: Motion, modal: Modal, label: Callable[[], tuple[int | None, int | None]]) -> None:
        """Take the present state; `label` tells the O number and the N number."""
        self._motion, self._modal, self._label = motion, modal, label

    def read(self, number: int) -> Value:
        """Raises KeyError for a number that is no variable here."""
        if number in _SECONDS_PER:
            return (self._time - self._started[number]) / _SECONDS_PER[number]
        if number in _GROUP_OF:
            return self._modal.codes[_GROUP_OF[number]] / 10.0
        if 4101 <= number <= 4130:
            return self._modal_word(number)
        if 5001 <= number <= 5100:
            return self._position(number)
        if place := self._work_place(number):
            name, letter = place
            return self._shown(self.offsets.work.get(name, {}).get(letter, 0.0), letter)
        memory, offset, letter = self._tool_place(number)
        tables = {
            _Memory.WEAR: self.offsets.wear,
            _Memory.GEOMETRY: self.offsets.tool,
            _Memory.NOSE: self.offsets.nose,
        }
        value = tables[memory].get(offset, {}).get(letter, 0.0)
        return value if letter == "Q" else self._shown(value, letter)

    def write(self, number: int, value: Value) -> None:
        """Raises KeyError for no variable, PermissionError for one that is only read."""
        amount = value or 0.0
        if number in _SECONDS_PER:
            self._started[number] = self._time - amount * _SECONDS_PER[number]
            return
        if place := self._work_place(number):
            name, letter = place
            self.offsets = self.offsets.with_work(_tenths(name), letter, self._stored(amount, letter))
            return
        if number in _GROUP_OF or 4101 <= number <= 4130 or 5001 <= number <= 5100:
            raise PermissionError
        memory, offset, letter = self._tool_place(number)
        stored = amount if letter == "Q" else self._stored(amount, letter)
        change = {
            _Memory.WEAR: self.offsets.with_wear,
            _Memory.GEOMETRY: self.offsets.with_geometry,
            _Memory.NOSE: self.offsets.with_nose,
        }
        self.offsets = change[memory](offset, letter, stored)

    @property
    def _time(self) -> float:
        return self._motion.time if self._motion else 0.0

    def _modal_word(self, number: int) -> Value:
        modal = self._modal
        program, label = self._label()
        speed = modal.surface_speed if modal.constant_surface_speed else modal.rpm
        words: dict[int, Value] = {
            4109: modal.feed,
            4113: modal.m_code,
            4114: label,
            4115: program,
            4119: modal.sync_rpm if modal.gear else speed,
            4120: modal.tool * 100 + (modal.tool_offset or 0),
        }
        value = words[number]
        return None if value is None else float(value)

    def _position(self, number: int) -> Value:
        """#5001 end of block, #5021 machine, #5041 present, #5061 skip, #5081 tool offset."""
        base = max(one for one in _POSITIONS if one < number)
        column = number - base - 1
        motion, machine = self._motion, self._machine
        if motion is None or column >= len(machine.axes):
            raise KeyError(number)
        axis = machine.axes[column]
        if base == 5080:
            value = self._modal.tool_shift.get(column, 0.0)
        elif base == 5060:
            if motion.skip_positions is None:
                return None
            value = float(motion.skip_positions[column])
        elif base == 5020:
            value = float(motion.timeline.positions(motion.time)[column])
        else:
            value = float(motion.registers.absolute[column])
        if axis.type_a and base != 5080:
            value = modulo(value)
        return self._shown(value * axis.factor, axis.letter)

    def _work_place(self, number: int) -> tuple[str, str] | None:
        """Name and axis letter of #5221 ff. (G54), #5241 ff. (G55) … #5321 ff. (G59)."""
        which, column = divmod(number - _FIRST_WORK_OFFSET, _WORK_STRIDE)
        if not 0 <= which < len(WORK_OFFSETS):
            return None
        if column >= len(self._machine.axes):
            raise KeyError(number)
        return WORK_OFFSETS[which], self._machine.letters[column]

    def _tool_place(self, number: int) -> tuple[_Memory, int, str]:
        """Memory, offset number and letter of #2001 to #2864."""
        for base, memory, letter in _TOOL_BASES:
            most = _MOST_OF_Y if letter == "Y" else _MOST_OF_A_KIND
            known = memory is _Memory.NOSE or letter in self._machine.letters
            if 1 <= number - base <= most and known:
                return memory, number - base, letter
        raise KeyError(number)

    def _shown(self, value: float, letter: str) -> float:
        return value / MM_PER_INCH if self._modal.inch and not self._is_rotary(letter) else value

    def _stored(self, value: float, letter: str) -> float:
        return value * MM_PER_INCH if self._modal.inch and not self._is_rotary(letter) else value

    def _is_rotary(self, letter: str) -> bool:
        return any(axis.rotary for axis in self._machine.axes if axis.letter == letter)


def _tenths(name: str) -> int:
    return next(code.tenths for code in G_CODES.values() if g_name(code.tenths) == name)
