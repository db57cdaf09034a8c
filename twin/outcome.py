"""How a run is made, and all that it found."""

from dataclasses import dataclass

from controller.operator.actions import OperatorEvent
from twin.advice.advice import Advice
from twin.cutting.chips import Chips
from twin.cutting.cut import CutResult
from twin.errors import ExitCode
from twin.inspection.result import Inspection, Verdict
from twin.job.schema import Job
from twin.load.loaded import LoadedRun
from twin.regression.judge import Miss
from twin.session import Session
from twin.setup import Ready


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """How a run is made."""

    ideal: bool = False
    """axes follow their setpoints exactly"""
    cell_mm: float | None = None
    """cell of the cutting grid; None = chosen"""
    tolerance_um: float = 1.0
    """how far facets of a flank may stand off the cut; three times as far in roots, twice on other parts"""
    chips: bool = False
    """count what each tooth takes away"""
    events: tuple[OperatorEvent, ...] = ()
    """what the operator does, beside the events of the job"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """All that a run found."""

    job: Job
    options: Options
    ready: Ready
    session: Session
    cut: CutResult
    inspection: Inspection
    chips: Chips | None
    """where they were asked for"""
    loaded: LoadedRun | None
    """the cutting forces, where the job asks for them"""
    times: dict[str, float]
    """stage -> wall time [s]"""
    advice: tuple[Advice, ...] = ()
    """what job and program said before metal was cut"""
    missed: tuple[Miss, ...] = ()
    """what the job's `[expect]` did not get"""

    @property
    def exit_code(self) -> ExitCode:
        """1 for an alarm, a part that is not what was asked for, or an expectation that is not met.

        An alarm that the job expects is an alarm still.
        """
        out = self.inspection.verdict is Verdict.OUT
        return ExitCode.FINDING if self.session.alarms or out or self.missed else ExitCode.FINE
