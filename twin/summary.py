"""A run in words and rows, for its report."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from controller.tables.alarms import Alarm
from twin.advice.advice import Advice
from twin.contact import contact_of
from twin.cutters.disc_wheel import DiscWheel
from twin.cutters.hob import Hob
from twin.cutting.chips import Chips
from twin.load.figures import load_rows, load_words
from twin.outcome import Outcome
from twin.recording import Recording
from twin.report.data import Message, Part, Program, ReportData, Row, Severity, ToolOutline
from twin.sync import Spectrum

Floats = NDArray[np.float64]


def _drive_limits(outcome: Outcome) -> dict[str, float]:
    """What every drive has against cutting forces, by axis letter [N, N m]; nothing without them."""
    if outcome.loaded is None:
        return {}
    drives = outcome.ready.driven.drives()
    letters = outcome.session.recording.axes
    return {letter: drive.force_limit for letter, drive in zip(letters, drives, strict=True)}


def report_data(outcome: Outcome, deviation_um: Floats, origin: dict[str, object]) -> ReportData:
    """Everything that the report shows; `deviation_um` (n,) of the part's vertices."""
    remains = outcome.cut.remains
    return ReportData(
        title=outcome.job.name,
        job=tuple(_job_rows(outcome)),
        provenance=tuple(_provenance_rows(origin)),
        timing=tuple(Row(label=name, value=f"{t:.2f} s") for name, t in outcome.times.items()),
        recording=outcome.session.recording,
        rotary_axes=_rotary(outcome),
        sync_error_arcsec=_sync_error(outcome.session.recording),
        load=tuple(
            Row(label=label, value=value)
            for label, value in load_rows(
                outcome.loaded, outcome.session.recording.axes[outcome.ready.tool_column]
            )
        ),
        drive_limits=_drive_limits(outcome),
        messages=messages(outcome),
        contact=contact_of(outcome),
        part=Part(
            vertices=remains.vertices,
            faces=remains.faces,
            deviation_um=deviation_um,
            face_time_s=outcome.cut.face_time_s,
        ),
        inspection=outcome.inspection,
        programs=_programs(outcome),
        tools=tuple(
            ToolOutline(
                number=tool.number, radius_mm=tool.cutter.radius, half_length_mm=tool.cutter.half_length
            )
            for tool in outcome.ready.tools
        ),
    )


def messages(outcome: Outcome) -> tuple[Message, ...]:
    """Alarms and warnings of the controller, the advice on the job, then what the cut has to say."""
    said: list[tuple[Severity, Alarm | Advice]] = [(Severity.ALARM, a) for a in outcome.session.alarms]
    said += [(Severity.WARNING, a) for a in (*outcome.session.warnings, *outcome.advice)]
    notes = [Message(severity=Severity.WARNING, number="CUT", text=note) for note in outcome.cut.notes]
    missed = [
        Message(
            severity=Severity.WARNING,
            number="EXPECT",
            text=f"{miss.key} is not as expected",
            found=f"{miss.got}, expected {miss.expected}",
        )
        for miss in outcome.missed
    ]
    return tuple(_message(severity, a) for severity, a in said) + tuple(notes) + tuple(missed)


def _message(severity: Severity, alarm: Alarm | Advice) -> Message:
    span = alarm.span
    return Message(
        severity=severity,
        number=alarm.number,
        text=alarm.text,
        file=span.file if span else "",
        line=span.line if span else None,
        column=span.column if span else None,
        found=alarm.found,
        remedy=alarm.remedy,
    )


def _job_rows(outcome: Outcome) -> list[Row]:
    job, result = outcome.job, outcome.cut
    machine = f"{job.machine.model}, set-up {job.machine.setup}"
    rows = [
        Row(label="Machine", value=machine + (", ideal axes" if outcome.options.ideal else ", servo drives"))
    ]
    if changed := _changed(job.machine.changes()):
        rows.append(Row(label="Machine values", value=f"changed by the job: {changed}"))
    blank = f"Ø {job.work.diameter_mm:g} × {job.work.length_mm:g} mm"
    if job.work.profile:
        blank += " turned to " + ", ".join(f"Ø {d:g} at z {z:g}" for z, d in job.work.profile)
    if job.work.bore_mm:
        blank += f", bore {job.work.bore_mm:g} mm"
    rows.append(Row(label="Blank", value=f"{blank}, {job.work.material}"))
    for number, tool in job.tools.items():
        if isinstance(tool, Hob):
            text = (
                f"{tool.hand}-hand hob m {tool.normal_module_mm:g} mm, Ø {tool.outside_diameter_mm:g} mm, "
                f"{tool.starts} start(s), {tool.gashes} gashes"
            )
        elif isinstance(tool, DiscWheel):
            text = f"disc wheel, Ø {tool.outside_diameter_mm:g} × {tool.breadth_mm:.4g} mm"
        else:
            text = f"polygon head, {tool.inserts} insert(s) on radius {tool.tip_radius_mm:g} mm"
        rows.append(Row(label=f"Tool T{number:02d}" if number else "Tool", value=text))
    rows.append(Row(label="Program", value=job.program.name))
    if outcome.session.skipped_s:
        skipped = f"{outcome.session.skipped_s:.1f} s at standstill are left out of the recording"
        rows.append(Row(label="Dwell", value=skipped))
    if found := outcome.session.recording.sync_spectrum:
        rows.append(Row(label="Gear box", value=sync_words(found)))
    rows.append(
        Row(
            label="Cut",
            value=f"{result.passes} passes near the stock; {result.method}; cell "
            + " × ".join(f"{c:.3f}" for c in result.cell_mm)
            + " mm",
        )
    )
    if result.checked:
        rows.append(
            Row(
                label="Check",
                value=f"{result.checked} vertices of the cut surface against all passes: largest error "
                f"{result.largest_error_um:.2g} µm; as many facets: {result.facet_error_um:.2g} µm",
            )
        )
    remains = result.remains
    rows.append(
        Row(
            label="Volume",
            value=f"blank {remains.blank_volume_mm3:.1f} mm³, part {remains.volume_mm3:.1f} mm³",
        )
    )
    if outcome.chips is not None:
        rows.append(Row(label="Chips", value=chip_words(outcome.chips)))
    if outcome.loaded is not None:
        rows.append(Row(label="Cutting forces", value=load_words(outcome.loaded)))
    return rows


def _changed(table: Mapping[str, Any], prefix: str = "") -> str:
    """`drives.x_slide.position_gain = 50`, one after the other."""
    said = [
        _changed(value, f"{prefix}{key}.") if isinstance(value, Mapping) else f"{prefix}{key} = {value}"
        for key, value in table.items()
    ]
    return ", ".join(one for one in said if one)


def sync_words(found: Spectrum) -> str:
    """The synchronisation error in one line."""
    text = (
        f"error at {abs(found.work_rpm):.4g} rpm of the work: mean {signed(found.mean_arcsec, 2)}″, "
        f"rms {found.rms_arcsec:.2g}″ about it"
    )
    if lines := found.strongest(1):
        ((order, per_tool, amplitude),) = lines
        text += (
            f"; strongest line {amplitude:.2g}″, {order:.4g} a turn of the work, {per_tool:.4g} of the tool"
        )
    return text


def signed(value: float, digits: int) -> str:
    """A number with its sign, and no sign on what rounds to zero."""
    rounded = round(value, digits)
    return f"{rounded:+.{digits}f}" if rounded else f"{0.0:.{digits}f}"


def chip_words(chips: Chips) -> str:
    """The chips in one line."""
    if not len(chips.volume_mm3):
        return "no chips"
    volume, thick = chips.volume_mm3, chips.thickness_max_mm
    return (
        f"{len(volume)} chips, {chips.total_mm3:.1f} mm³ in all, the largest {volume.max():.3g} mm³; "
        f"thickness up to {thick.max():.3f} mm (cells of {chips.resolution_mm:.2g} mm)"
    )


def _provenance_rows(origin: dict[str, object]) -> list[Row]:
    rows: list[Row] = []
    for section, values in origin.items():
        if isinstance(values, dict):
            for name, value in values.items():
                shown = f"{value['file']}  {value['sha256']}" if section == "inputs" else str(value)
                rows.append(Row(label=f"{section}: {name}", value=shown))
    return rows


def _sync_error(recording: Recording) -> Floats | None:
    """(n,) for the plots; None where the gear box was never on."""
    return recording.sync_error_arcsec if recording.sync.any() else None


def _rotary(outcome: Outcome) -> frozenset[str]:
    letters = outcome.session.recording.axes
    return frozenset(letters[k] for k in (outcome.ready.work_column, outcome.ready.tool_column))


def _programs(outcome: Outcome) -> tuple[Program, ...]:
    """The main program, then what else moved something: the files of subprograms."""
    main = outcome.job.program
    moved = dict.fromkeys(block.file for block in outcome.session.recording.blocks)
    others = [Path(name) for name in moved if Path(name) != main]
    return tuple(Program(name=str(path), text=_text(path)) for path in (main, *others) if path.is_file())


def _text(path: Path) -> str:
    data = path.read_bytes()
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("gbk", errors="replace")
