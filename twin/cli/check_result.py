"""What a check has found."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from controller.dry_run import DryRun
from controller.language.source import Program
from controller.tables.alarms import Alarm
from controller.tables.machine_data import MachineData
from twin.errors import ExitCode

if TYPE_CHECKING:
    from twin.advice.advice import Advice  # a bare program needs none of this


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckResult:
    """A dry run, what else its program holds, and the advice on its job."""

    run: DryRun
    machine: MachineData
    program: Program
    read_on: tuple[Alarm, ...] = ()
    """alarms behind the first one, in lines that were read, not run"""
    advice: "tuple[Advice, ...]" = ()

    @property
    def messages(self) -> "tuple[Alarm | Advice, ...]":
        """Warnings, advice, the alarm, and what was read behind it."""
        return (*self.run.warnings, *self.advice, *self.run.alarms, *self.read_on)

    @property
    def warnings(self) -> "tuple[Alarm | Advice, ...]":
        """Warnings of the controller, and the advice that warns."""
        return (*self.run.warnings, *(one for one in self.advice if one.warns))

    def exit_code(self, *, strict: bool) -> ExitCode:
        """1 for an alarm; where it is `strict` for a warning, too."""
        finding = self.run.alarms or (strict and self.warnings)
        return ExitCode.FINDING if finding else ExitCode.FINE
