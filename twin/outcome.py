"""How a run is made, and all that it found."""

from dataclasses import dataclass

from twin.cutting.cut import CutResult
from twin.errors import ExitCode
from twin.inspection.result import Inspection, Verdict
from twin.job.schema import Job
from twin.session import Session
from twin.setup import Ready


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """How a run is made."""

    ideal: bool = False
    """axes follow their setpoints exactly"""
    cell_mm: float | None = None
    """cell of the cutting grid; None = chosen"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """All that a run found."""

    job: Job
    options: Options
    ready: Ready
    session: Session
    cut: CutResult
    inspection: Inspection
    times: dict[str, float]
    """stage -> wall time [s]"""

    @property
    def exit_code(self) -> ExitCode:
        """1 for an alarm or a part that is not what was asked for."""
        out = self.inspection.verdict is Verdict.OUT
        return ExitCode.FINDING if self.session.alarms or out else ExitCode.FINE
