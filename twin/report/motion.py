"""Axes and spindles over time: where they were told to be, how far behind they were, when coupled."""

import numpy as np
from matplotlib.axes import Axes

from twin.inspection.result import Floats
from twin.recording import Recording
from twin.report.scale import largest
from twin.report.style import BAND, GREY, LEFT, RIGHT, figure, quiet, styled, to_svg

COLUMNS = 500
"""of the envelope: about one a printed half millimetre"""


def motion_chart(recording: Recording, rotary: frozenset[str]) -> str | None:
    """SVG of every axis: position (speed where it turns) and following error; None below two samples."""
    time = recording.time_s
    if len(time) < 2 or not recording.axes:
        return None
    rows = len(recording.axes)
    with styled():
        sheet = figure(0.75 + 0.95 * rows)
        grid = sheet.subplots(
            rows + 1,
            2,
            sharex=True,
            squeeze=False,
            height_ratios=[0.22, *[1.0] * rows],
            gridspec_kw={
                "left": 0.085,
                "right": 0.985,
                "wspace": 0.16,
                "hspace": 0.2,
                "top": 1 - 0.25 / (0.75 + 0.95 * rows),
                "bottom": 0.4 / (0.75 + 0.95 * rows),
            },
        )
        spans = sync_spans(recording)
        for axes, title in zip(grid[0], ("Setpoint and actual", "Following error"), strict=True):
            axes.set_title(title)
            _draw_band(axes, spans)
        for k, letter in enumerate(recording.axes):
            turns = letter in rotary
            _draw_axis(grid[k + 1, 0], recording, k, turns)
            _draw_error(grid[k + 1, 1], recording, k, turns)
        for axes in grid[1:].flat:
            _shade(axes, spans, BAND)
        if time[-1] > time[0]:
            grid[0, 0].set_xlim(time[0], time[-1])
        for axes in grid[-1]:
            axes.set_xlabel("time [s]", labelpad=1)
        return to_svg(sheet, "motion", "Setpoint, actual value and following error of every axis over time")


def envelope(time: Floats, value: Floats, columns: int = COLUMNS) -> tuple[Floats, Floats]:
    """Keep of every one of `columns` equal runs of samples the smallest and the largest, in order of time.

    What is kept are samples as they were recorded, the first and the last one among them; a single-sample
    spike survives. (n,) in, at most (2 columns + 2,) out; non-finite samples are left out.
    """
    finite = np.isfinite(value) & np.isfinite(time)
    time, value = time[finite], value[finite]
    if len(value) <= 2 * columns:
        return time, value
    edges = np.linspace(0, len(value), columns + 1).astype(int)
    start, length = edges[:-1], np.diff(edges)
    run = np.repeat(np.arange(columns), length)
    order = np.lexsort((value, run))
    keep = np.unique(np.concatenate([order[start], order[start + length - 1], [0, len(value) - 1]]))
    return time[keep], value[keep]


def speed_rpm(time: Floats, angle_deg: Floats) -> Floats:
    """(n - 1,) mean speed between samples; NaN where time stands still."""
    step = np.diff(time)
    return np.divide(np.diff(angle_deg), 6.0 * step, out=np.full(len(step), np.nan), where=step > 0)


def sync_spans(recording: Recording) -> list[tuple[float, float]]:
    """Times from which to which the electronic gear box was engaged."""
    edge = np.flatnonzero(np.diff(np.concatenate([[0], recording.sync.astype(np.int8), [0]])))
    last = len(recording.time_s) - 1
    return [
        (float(recording.time_s[a]), float(recording.time_s[min(b, last)]))
        for a, b in zip(edge[::2], edge[1::2], strict=True)
    ]


def _shade(axes: Axes, spans: list[tuple[float, float]], colour: str, opacity: float = 1.0) -> None:
    bars = [(start, end - start) for start, end in spans]
    whole_height = axes.get_xaxis_transform()
    axes.broken_barh(bars, (0, 1), transform=whole_height, color=colour, alpha=opacity, zorder=0, linewidth=0)


def _draw_band(axes: Axes, spans: list[tuple[float, float]]) -> None:
    quiet(axes, "left", "bottom")
    axes.set_ylim(0, 1)
    _shade(axes, spans, LEFT, opacity=0.35)
    if spans:
        start, end = max(spans, key=lambda span: span[1] - span[0])
        axes.text((start + end) / 2, 0.5, "in sync", ha="center", va="center", fontsize=6.0)
    else:
        axes.text(
            0.5,
            0.5,
            "never in sync",
            transform=axes.transAxes,
            ha="center",
            va="center",
            fontsize=6.0,
            color=GREY,
        )


def _draw_axis(axes: Axes, recording: Recording, k: int, turns: bool) -> None:
    letter = recording.axes[k]
    for values, name, colour, width in (
        (recording.setpoint[:, k], "setpoint", LEFT, 1.8),
        (recording.actual[:, k], "actual", RIGHT, 0.7),
    ):
        if turns:
            time, value = envelope(recording.time_s[1:], speed_rpm(recording.time_s, values))
        else:
            time, value = envelope(recording.time_s, values)
        axes.plot(
            time,
            value,
            color=colour,
            linewidth=width,
            alpha=0.5 if width > 1 else 1.0,
            label=name,
            gid=f"{letter}-{name}",
        )
    axes.set_ylabel(f"{letter}  [{'rpm' if turns else 'mm'}]")
    if k == 0:
        axes.legend(loc="upper right", ncols=2, borderaxespad=0, handlelength=1.2)


def _draw_error(axes: Axes, recording: Recording, k: int, turns: bool) -> None:
    error = recording.setpoint[:, k] - recording.actual[:, k]
    small = largest(error) < (0.1 if turns else 1.0)
    unit, factor = (
        (("″", 3600.0) if small else ("°", 1.0)) if turns else (("µm", 1e3) if small else ("mm", 1.0))
    )
    time, value = envelope(recording.time_s, error * factor)
    axes.axhline(0, color=GREY, linewidth=0.5)
    axes.plot(time, value, color=RIGHT, linewidth=0.7, gid=f"{recording.axes[k]}-error")
    axes.set_ylabel(f"{recording.axes[k]}  [{unit}]")
