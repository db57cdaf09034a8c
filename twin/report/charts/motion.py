"""Axes and spindles over time: where they were told to be, how far behind they were, when coupled."""

from dataclasses import dataclass

import numpy as np
from markupsafe import Markup

from twin.inspection.result import Floats
from twin.recording import Recording
from twin.report.drawing import Drawing, Plot
from twin.report.scale import largest

COLUMNS = 500
"""of the envelope: about six a printed millimetre"""
WIDTH = 180.0
"""[mm]"""
GUTTER = 13.5
"""left of each plot, for its figures [mm]"""
BAND_TOP, BAND = 6.0, 3.6
"""of the strip that shows the gear box engaged [mm]"""
TALL, GAP = 17.0, 4.5
"""of each plot, and below it [mm]"""
FLAT = 1e-3
"""[mm, rpm, µm, ″] that a curve must rise, to be drawn larger than it is"""


@dataclass(frozen=True, slots=True, kw_only=True)
class MotionChart:
    """The drawing, and where in it time runs."""

    svg: Markup
    panels: tuple[tuple[float, float, float, float], ...]
    """left, top, width, height [mm] of every plot; all share the span of time"""
    time: tuple[float, float]
    """[s] at their left and right"""


def motion_chart(
    recording: Recording, rotary: frozenset[str], sync_error_arcsec: Floats | None = None
) -> MotionChart | None:
    """SVG of every axis: position (speed where it turns) and following error; None below two samples.

    `sync_error_arcsec` (n,) of the work against the tool, NaN out of sync, gets a plot of its own.
    """
    time = recording.time_s
    if len(time) < 2 or not recording.axes:
        return None
    span = (float(time[0]), float(time[-1]))
    rows = len(recording.axes) + (sync_error_arcsec is not None)
    first = BAND_TOP + BAND + 2.0
    drawing = Drawing("motion", WIDTH, first + rows * (TALL + GAP) + 4.5)
    width = WIDTH / 2 - GUTTER - 1.5
    lefts = (GUTTER, WIDTH / 2 + GUTTER)
    spans = sync_spans(recording)
    panels: list[Plot] = []

    def plot(left: float, row: int, values: tuple[float, float], wide: float = width) -> Plot:
        top = first + row * (TALL + GAP)
        made = Plot(drawing, left=left, top=top, width=wide, height=TALL, x=span, y=values)
        for start, end in spans:
            made.span(start, end, "synced")
        panels.append(made)
        return made

    for left, title in zip(lefts, ("Setpoint and actual", "Following error"), strict=True):
        drawing.text(left, 3.6, title, "title")
        _draw_band(
            drawing, Plot(drawing, left=left, top=BAND_TOP, width=width, height=BAND, x=span, y=(0, 1)), spans
        )
    _key(drawing, lefts[0] + width)
    for k, letter in enumerate(recording.axes):
        turns = letter in rotary
        curves = _values(recording, k, turns)
        drawn = plot(lefts[0], k, _room([value for _, value, _ in curves]))
        drawn.grid(most=5)
        for t, value, name in curves:
            drawn.curve(t, value, name, id=f"{letter}-{name}")
        drawn.y_axis(f"{letter}  [{'rpm' if turns else 'mm'}]", most=5, room=GUTTER - 2.2)
        t, error, unit = _error(recording, k, turns)
        drawn = plot(lefts[1], k, _room([error, np.zeros(1)]))
        drawn.grid(most=5)
        drawn.level(0.0, "zero")
        drawn.curve(t, error, "error", id=f"{letter}-error")
        drawn.y_axis(f"{letter}  [{unit}]", most=5, room=GUTTER - 2.2)
    if sync_error_arcsec is not None:
        t, error = envelope(time, sync_error_arcsec, 2 * COLUMNS)
        drawn = plot(GUTTER, rows - 1, _room([error, np.zeros(1)]), WIDTH - GUTTER - 1.5)
        drawn.level(0.0, "zero")
        drawn.curve(t, error, "error", id="sync-error")
        drawn.y_axis("sync  [″]", most=5, room=GUTTER - 2.2)
        drawn.x_axis("time [s]")
    else:
        for last in panels[-2:]:
            last.x_axis("time [s]", most=7)
    return MotionChart(
        svg=drawing.svg("Setpoint, actual value and following error of every axis over time"),
        panels=tuple((p.left, p.top, p.right - p.left, p.bottom - p.top) for p in panels),
        time=span,
    )


def envelope(time: Floats, value: Floats, columns: int = COLUMNS) -> tuple[Floats, Floats]:
    """Keep of every one of `columns` equal runs of samples the smallest and the largest, in order of time.

    What is kept are samples as they were recorded, the first and the last one among them; a single-sample
    spike survives. (n,) in, at most (2 columns + 2,) out; non-finite samples are left out.
    """
    finite = np.isfinite(value) & np.isfinite(time)
    if not finite.all():
        time, value = time[finite], value[finite]
    n = len(value)
    if n <= 2 * columns:
        return time, value
    edges = np.linspace(0, n, columns + 1).astype(int)
    keep = [np.array([0, n - 1])]
    for extreme in (np.minimum, np.maximum):
        best = np.repeat(extreme.reduceat(value, edges[:-1]), np.diff(edges))
        hits = np.flatnonzero(value == best)
        run = np.searchsorted(edges, hits, side="right")
        keep.append(hits[np.diff(run, prepend=-1) > 0])
    chosen = np.unique(np.concatenate(keep))
    return time[chosen], value[chosen]


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


def _values(recording: Recording, k: int, turns: bool) -> list[tuple[Floats, Floats, str]]:
    """Times, values and names of the setpoint and the actual value of an axis."""
    curves = []
    for values, name in ((recording.setpoint[:, k], "setpoint"), (recording.actual[:, k], "actual")):
        if turns:
            curves.append((*envelope(recording.time_s[1:], speed_rpm(recording.time_s, values)), name))
        else:
            curves.append((*envelope(recording.time_s, values), name))
    return curves


def _error(recording: Recording, k: int, turns: bool) -> tuple[Floats, Floats, str]:
    """Times, following error of an axis, and its unit."""
    error = recording.setpoint[:, k] - recording.actual[:, k]
    small = largest(error) < (0.1 if turns else 1.0)
    unit, factor = (
        (("″", 3600.0) if small else ("°", 1.0)) if turns else (("µm", 1e3) if small else ("mm", 1.0))
    )
    return *envelope(recording.time_s, error * factor), unit


def _room(values: list[Floats]) -> tuple[float, float]:
    """Range that holds all values (finite), with a margin; about ±1 where they hardly differ."""
    every = np.concatenate(values)
    low, high = (float(every.min()), float(every.max())) if every.size else (0.0, 0.0)
    margin = 0.08 * (high - low) if high - low > FLAT else 1.0
    return low - margin, high + margin


def _draw_band(drawing: Drawing, plot: Plot, spans: list[tuple[float, float]]) -> None:
    """Strip above the plots: when the electronic gear box was engaged."""
    plot.band(0, 1, "idle")
    for start, end in spans:
        plot.span(start, end, "engaged")
    middle, text = (plot.left + plot.right) / 2, "never in sync"
    if spans:
        start, end = max(spans, key=lambda span: span[1] - span[0])
        middle, text = float(plot.across((start + end) / 2)), "in sync"
    drawing.text(middle, plot.bottom - 1.0, text, "small", anchor="middle")


def _key(drawing: Drawing, right: float) -> None:
    for x, name in ((right - 29.0, "setpoint"), (right - 12.0, "actual")):
        drawing.line([(x, 2.8), (x + 4.0, 2.8)], name)
        drawing.text(x + 5.0, 3.6, name, "small")
