"""A job's program without machine and metal, and the advice on it."""

from collections.abc import Callable

from controller.dry_run import DryRun, dry_run
from controller.language.source import Program
from controller.observed import Observed
from controller.tables.machine_data import machine_data
from twin.advice.advice import Advice
from twin.advice.adviser import Adviser
from twin.advice.scene import scene_of
from twin.cutters.cutter import Cutter
from twin.job.schema import Job
from twin.presets import ControllerSettings


def advised_run(
    job: Job,
    cutters: dict[int, Cutter],
    settings: ControllerSettings,
    program: Program,
    *,
    observe: Callable[[Observed], None] | None = None,
) -> tuple[DryRun, tuple[Advice, ...]]:
    """Run a program to its end or its first alarm; `observe` is told every command, as the adviser is.

    Raises what `dry_run` raises.
    """
    adviser = Adviser(scene_of(job, cutters, machine_data(settings.parameters)))

    def see(seen: Observed) -> None:
        adviser.see(seen)
        if observe:
            observe(seen)

    found = dry_run(
        program,
        settings.parameters,
        settings.offsets,
        settings.signals,
        events=settings.events,
        observe=see,
    )
    return found, adviser.close()
