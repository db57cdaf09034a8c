"""A job from its files to its result folder."""

import json
import math
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from controller.dry_run import DryRun
from controller.language.source import load_program
from controller.tables.alarms import as_json
from twin.advice.advice import advice_as_json
from twin.advice.dry import advised_run
from twin.clashes.clashes import judged
from twin.course import CHUNK, Course
from twin.cutting.chips import chips
from twin.cutting.cut import cut
from twin.cutting.plan import plan_grid
from twin.inspection.deviation import deviations
from twin.inspection.inspection import inspect_solid
from twin.inspection.sheet import to_json
from twin.inspection.solid import check_solid
from twin.job.schema import Job
from twin.load.figures import load_figures
from twin.load.loaded import run_under_load
from twin.outcome import Options, Outcome
from twin.output.arrays import save_arrays
from twin.output.background import Background
from twin.output.folder import require_replaceable, result_folder
from twin.output.meshes import write_3mf, write_glb, write_stl
from twin.output.provenance import provenance
from twin.presets import cutters_of, settings_of
from twin.progress import Reporter, Silent
from twin.regression.judge import misses
from twin.report.charts.contact import contact_file
from twin.report.page import write_report
from twin.session import Session, begin_program, session_of
from twin.setup import Ready, make_ready, require_analogue
from twin.summary import report_data

BYTES_PER_SAMPLE = 160
"""Of a recording on the disk, before compression."""


@dataclass(slots=True)
class Stopwatch:
    """Wall time by stage."""

    stages: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def measure(self, name: str) -> Iterator[None]:
        """Add the time of the block to a stage."""
        start = time.perf_counter()
        yield
        self.stages[name] = self.stages.get(name, 0.0) + time.perf_counter() - start


def run_job(job: Job, out: Path, options: Options, reporter: Reporter | None = None) -> Outcome:
    """Run, cut, inspect, report; writes the folder `out`.

    Raises HobtwinError and the controller's errors for what a user can mend; nothing is written then.
    """
    tell = reporter or Silent()
    require_replaceable(out)
    watch = Stopwatch()
    with watch.measure("set-up"):
        cutters = cutters_of(job)
        settings = settings_of(job, cutters, events=options.events)
        program = load_program(job.program)
        foreseen, advice = advised_run(job, cutters, settings, program)
        ready = make_ready(job, cutters, lowest_z_mm=lowest_z(job, foreseen))
        require_analogue(ready, settings.parameters)
        cycle = foreseen.cycle_time_s
        blank = job.work.blank()
        # the cut says at once what it would need, not after the run
        tip = foreseen.extents["X"].machine[0] + job.setup.reference.X if "X" in foreseen.extents else 0.0
        plan_grid(
            blank,
            cutters.values(),
            closest=max(tip / 2.0, 0.0),
            cell_mm=options.cell_mm,
            tolerance_um=options.tolerance_um,
        )
    period = ready.spec.control_period_s
    size = math.ceil(cycle / period) * BYTES_PER_SAMPLE / 1e6
    tell.stage(f"running {cycle:.0f} s of machine time (recording up to {size:.0f} MB)")

    with watch.measure("machine"):
        course = begin_program(
            program,
            settings,
            ready,
            ideal=options.ideal,
            progress=lambda seconds: tell.share(seconds / max(cycle, period)),
        )
        loaded = (
            run_under_load(
                job, ready, course, begin_program(program, settings, ready, ideal=True), tell=tell.stage
            )
            if job.physics.cutting_load
            else None
        )
        session = judged(blank, loaded.session if loaded else _gone(course, ready))
    with result_folder(out) as folder, Background() as background:
        background.start(session.recording.save, folder / "recording.npz")
        tell.stage("cutting")
        with watch.measure("cutting"):
            result = cut(
                blank,
                session.motions,
                cell_mm=options.cell_mm,
                tolerance_um=options.tolerance_um,
                progress=lambda _stage, share: tell.share(share),
            )
        mesh = result.remains.vertices, result.remains.faces
        background.start(write_3mf, folder / "part.3mf", *mesh)
        background.start(write_stl, folder / "part.stl", *mesh)
        background.start(write_glb, folder / "part.glb", *mesh)
        taken = None
        if options.chips:
            tell.stage("counting the chips")
            with watch.measure("chips"):
                taken = chips(blank, session.motions, progress=lambda _stage, share: tell.share(share))
            background.start(save_arrays, folder / "chips.npz", taken.columns())
        tell.stage("inspecting")
        with watch.measure("inspection"):
            if job.inspection.datum == "spindle":
                mesh = ready.tools[0].kinematics.mount.moved(mesh[0]), mesh[1]
            solid = check_solid(*mesh)
            inspection = inspect_solid(solid, job.nominal, own_axis=job.inspection.datum == "fit")
            deviation = deviations(solid, inspection)
        outcome = Outcome(
            job=job,
            options=options,
            ready=ready,
            session=session,
            cut=result,
            inspection=inspection,
            chips=taken,
            loaded=loaded,
            times=watch.stages,
            advice=advice,
            missed=misses(
                job.expect,
                {**to_json(inspection), **load_figures(loaded)},
                alarms=[alarm.number for alarm in session.alarms],
                warnings=[warning.number for warning in (*session.warnings, *advice)],
            ),
        )
        tell.stage("writing the report")
        with watch.measure("files"):
            background.finish()
        _write(folder, outcome, deviation, watch)
    return outcome


def _gone(course: Course, ready: Ready) -> Session:
    course.go()
    return session_of(course, ready)


def lowest_z(job: Job, foreseen: DryRun) -> float | None:
    """How far the program takes the tool's centre towards the chuck, from the front face [mm]; None where the
    dry run ended at a touch that only a machine can tell of."""
    if foreseen.alarms and any(warning.number == "HT9133" for warning in foreseen.warnings):
        return None
    lowest = foreseen.extents["Z"].machine[0] if "Z" in foreseen.extents else 0.0
    return lowest + job.setup.reference.Z


def _write(folder: Path, outcome: Outcome, deviation: NDArray[np.float64], watch: Stopwatch) -> None:
    session, job = outcome.session, outcome.job
    _json(folder / "inspection.json", figures(outcome))
    _json(
        folder / "alarms.json",
        {
            "alarms": [as_json(a) for a in session.alarms],
            "warnings": [
                *(as_json(a) for a in session.warnings),
                *(advice_as_json(a) for a in outcome.advice),
            ],
        },
    )
    origin = provenance(
        {
            "job": job.path,
            "program": job.program,
            **{path.stem: path for path in sorted(outcome.ready.spec.folder.glob("*.*ml"))},
        },
        {
            "ideal": outcome.options.ideal,
            "chunk_ticks": CHUNK,
            "control_period_s": outcome.ready.spec.control_period_s,
            "cell_mm": list(outcome.cut.cell_mm),
            "method": outcome.cut.method,
        },
    )
    _json(folder / "provenance.json", origin)
    with watch.measure("report"):
        report = report_data(outcome, deviation, origin)
        if report.contact is not None:
            (folder / "collision.svg").write_text(contact_file(report.contact), encoding="utf-8")
        write_report(folder / "report.html", report)


def figures(outcome: Outcome) -> dict[str, object]:
    """What inspection.json holds: what was measured on the part, and what cut it."""
    return {**to_json(outcome.inspection), **load_figures(outcome.loaded)}


def _json(path: Path, value: object) -> None:
    path.write_text(json.dumps(value, indent=2, ensure_ascii=False, allow_nan=False) + "\n", encoding="utf-8")
