"""The program beside the motion: which block did what, when, and where; `process.js` joins them."""

import json
import math
from collections.abc import Iterable
from pathlib import PurePath

import numpy as np
from markupsafe import Markup

from twin.report import tables
from twin.report.blocks import BlockFacts, block_facts, lines_at
from twin.report.charts.motion import MotionChart, motion_chart
from twin.report.data import ReportData
from twin.report.sections.section import Section, Tab


def process_section(report: ReportData) -> Section | None:
    """Show listing and plots; None where there is neither."""
    recording = report.recording
    if recording is None and not report.programs:
        return None
    motion = motion_chart(recording, report.rotary_axes, report.sync_error_arcsec) if recording else None
    facts = block_facts(recording) if recording else ()
    areas = _areas(report, len(facts))
    number = {(fact.file, fact.line): k for k, fact in enumerate(facts)}
    programs = []
    shown: set[int] = set()
    for program in report.programs:
        lines = []
        for line in tables.listing(program, report.messages):
            block = None if line.number is None else number.get((program.name, line.number))
            if block is not None:
                shown.add(block)
            lines.append((line, block))
        programs.append((PurePath(program.name).name, lines))
    data = _data(report, motion, {k: facts[k] for k in sorted(shown)}) | {"areas": areas}
    return Section(
        name="process",
        tab=Tab.PROCESS,
        title="The program and what the machine did",
        values={
            "motion": motion,
            "recorded": recording is not None,
            "programs": programs,
            "data": Markup(json.dumps(data, separators=(",", ":"))),
            "solid": report.solid_part is not None,
            "patches": any(areas),
        },
        own_page=True,
    )


def _data(report: ReportData, motion: MotionChart | None, facts: dict[int, BlockFacts]) -> dict[str, object]:
    """What the script needs of the run: axes, panels of the plots, tools, and the blocks by their numbers."""
    axes = report.recording.axes if report.recording else ()
    return {
        "axes": [{"name": letter, "turns": letter in report.rotary_axes} for letter in axes],
        "panels": motion.panels if motion else (),
        "time": motion.time if motion else (0.0, 1.0),
        "tools": {
            tool.number: {
                "radius": tool.radius_mm,
                "half": tool.half_length_mm if math.isfinite(tool.half_length_mm) else None,
            }
            for tool in report.tools
        },
        "blocks": {k: _block(fact) for k, fact in facts.items()},
    }


def _areas(report: ReportData, count: int) -> list[float]:
    """(count,) area of the finished surface that each line made [mm²]; none where nobody knows."""
    part = report.solid_part
    if report.recording is None or part is None or not len(part.face_time_s):
        return []
    a, b, c = part.vertices.astype(np.float32).T.take(part.faces.T, axis=1).swapaxes(0, 1)
    size = 0.5 * np.sqrt(np.square(np.cross(b - a, c - a, axis=0)).sum(axis=0, dtype=np.float64))
    line = lines_at(report.recording, part.face_time_s)
    return _rounded(np.bincount(line[line >= 0], size[line >= 0], minlength=count), 2)


def _block(fact: BlockFacts) -> dict[str, object]:
    return {
        "runs": [_rounded(run, 4) for run in fact.runs],
        "count": fact.count,
        "duration": round(fact.duration_s, 4),
        "start": _rounded(fact.start, 4),
        "end": _rounded(fact.end, 4),
        "way": _rounded(fact.way, 4),
        "error": _rounded(fact.error, 6),
        "sync": fact.synced,
        "tool": fact.tool,
        "path": [None if np.isnan(point[0]) else _rounded(point, 2) for point in fact.path_mm],
        "axis": _rounded(fact.axis, 4),
    }


def _rounded(values: Iterable[float], digits: int) -> list[float]:
    return [round(float(value), digits) for value in values]
