"""Carries out macro statements: assignments, jumps and loops."""

from controller.commands import Command, ProgramStop
from controller.language.families.offset_blocks import shift_between
from controller.language.flow import Flow
from controller.language.macro.functions import Value
from controller.language.macro.statement import Assign, Conditional, Jump, Loop, Statement
from controller.language.macro.system import ALARM, LAST_USER_ALARM, MESSAGE_STOP, SystemVariables
from controller.language.macro.variables import Variables
from controller.language.modal import Modal
from controller.tables.alarms import alarm
from controller.tables.codes import Group
from controller.tables.machine_data import MachineData

LARGEST_LABEL = 99_999_999


class MacroRunner:
    """Carries out one statement after the other, on the variables and the flow of a program."""

    def __init__(self, machine: MachineData, variables: Variables, system: SystemVariables) -> None:
        self._machine = machine
        self._variables = variables
        self._system = system

    def run(self, statement: Statement, index: int, flow: Flow, modal: Modal) -> tuple[Command, ...]:
        """Carry out the statement on line `index`, put the flow on the next one; the commands it asks for.

        Raises AlarmError, PS0111-PS0119 for values, PS0060, PS0124, PS0128, HT9011, HT9015 for jumps, and
        MC3000 ff. for #3000.
        """
        self._variables.increment_digits = 0
        action = statement.action
        if isinstance(action, Conditional):
            if not action.condition(self._variables):
                flow.go_to(index + 1)
                return ()
            action = action.then
        if isinstance(action, Assign):
            commands = self._assign(action, statement, modal)
            flow.go_to(index + 1)
            return commands
        if isinstance(action, Jump):
            if action.condition is None or action.condition(self._variables):
                flow.jump_to_label(self._target(action), index, action.place)
            else:
                flow.go_to(index + 1)
        elif isinstance(action, Loop):
            holds = action.condition is None or bool(action.condition(self._variables))
            flow.begin_loop(action, index, holds=holds)
        else:
            flow.end_loop(action, index)
        return ()

    def _assign(self, assign: Assign, statement: Statement, modal: Modal) -> tuple[Command, ...]:
        """#i = value; #3000 raises an alarm, #3006 stops, a work offset in force moves the zero point."""
        number = int(assign.number(self._variables) or 0.0)
        value = assign.value(self._variables)
        message = assign.comment or "no message"
        if number == ALARM:
            raise alarm(f"MC{3000 + _user_alarm(value, assign)}", message, assign.place)
        if number == MESSAGE_STOP:
            return (ProgramStop(span=statement.span, message=message),)
        active = modal.codes[Group.WORK_OFFSET]
        before = self._system.offsets
        self._variables.write(number, value, assign.place)
        after = self._system.offsets
        if after is before:
            return ()
        return shift_between(before.of_work(active, self._machine), after.of_work(active, self._machine))

    def _target(self, jump: Jump) -> int:
        value = jump.target(self._variables)
        if value is None or value != round(value) or not 1 <= value <= LARGEST_LABEL:
            raise alarm("PS0128", f"GOTO {'the null value' if value is None else f'{value:g}'}", jump.place)
        return int(value)


def _user_alarm(value: Value, assign: Assign) -> int:
    """The n of #3000 = n."""
    number = 0.0 if value is None else value
    if number != round(number) or not 0 <= number <= LAST_USER_ALARM:
        raise alarm("PS0119", f"#3000 = {number:g}", assign.place, valid=f"0 to {LAST_USER_ALARM}")
    return int(number)
