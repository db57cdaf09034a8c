"""Single pitch, cumulative pitch and runout over the teeth, left and right flanks side by side."""

import numpy as np
from markupsafe import Markup

from twin.inspection.result import Flank, Floats, GearResult
from twin.report.drawing import Drawing, Plot, ticks
from twin.report.scale import largest, number

WIDTH = 180.0
"""[mm]"""
GUTTER = 11.0
"""left of each plot, for its figures [mm]"""
TALL = 27.0
"""of each plot [mm]"""
FIRST, BELOW = 7.0, 12.0
"""above the first plot, and below each [mm]"""
TOLERANCE_AT_MOST = 6.0
"""times the largest value that a tolerance may be, to be drawn"""


def pitch_chart(gear: GearResult) -> Markup | None:
    """SVG of f_p, F_p and, where it was measured, F_r over the teeth; None where no pitch was measured."""
    flanks = {"left": gear.left, "right": gear.right}
    curves = [values for flank in flanks.values() for values in (flank.pitch_um, flank.cumulative_um)]
    if not any(np.isfinite(values).any() for values in curves):
        return None
    depth = gear.ball_depth_um
    rows = 3 if np.isfinite(depth).any() else 2
    drawing = Drawing("pitch", WIDTH, FIRST + rows * (TALL + BELOW) - 2.0)
    width = WIDTH / 2 - GUTTER - 1.0
    for side, flank, left in (("left", gear.left, GUTTER), ("right", gear.right, WIDTH / 2 + GUTTER)):
        drawing.text(left + width / 2, 3.2, f"{side.capitalize()} flank", f"title {side}", anchor="middle")
        tolerance = gear.tolerances_um.get("single_pitch")
        plot = _plot(drawing, (left, width), 0, flank.pitch_um, _reach(curves[::2], tolerance))
        _tolerance(plot, tolerance)
        for tooth, value in enumerate(flank.pitch_um.tolist(), start=1):
            plot.bar(tooth, value, 0.7, f"bar {side}", id=f"{side}-single-{tooth}")
        _frame(plot, "f_{p}  [µm]", f"f_{{p}} {number(flank.single_pitch_um)} µm", "tooth")
        plot = _plot(drawing, (left, width), 1, flank.cumulative_um, _reach(curves[1::2], None))
        _curve(plot, flank, side)
    if rows == 3:
        plot = _plot(drawing, (GUTTER, WIDTH - GUTTER - 1.0), 2, depth, _reach([depth], None))
        _range(plot, depth)
        gaps = np.arange(1, len(depth) + 1)
        plot.curve(gaps, depth, "trace both", id="runout")
        _dots(plot, depth, "both")
        note = f"F_{{r}} {number(gear.runout_um)} µm, ball Ø {number(gear.pin_diameter_mm, 3)} mm"
        _frame(plot, "F_{r}  [µm]", note, "gap behind tooth")
    return drawing.svg("Single pitch, cumulative pitch and runout of every tooth, left and right flanks")


def _plot(drawing: Drawing, place: tuple[float, float], row: int, values: Floats, reach: float) -> Plot:
    """Axes over the teeth in a row of plots; `place` is their left and their width [mm]."""
    left, width = place
    top = FIRST + row * (TALL + BELOW)
    x = (0.3, max(len(values), 1) + 0.7)
    return Plot(drawing, left=left, top=top, width=width, height=TALL, x=x, y=(-reach, reach))


def _reach(curves: list[Floats], tolerance: float | None) -> float:
    """Value at the top of a plot: room for the largest, and for the tolerance where that is near."""
    worst = max(largest(values) for values in curves) or 1.0
    near = tolerance is not None and tolerance <= TOLERANCE_AT_MOST * worst
    return 1.25 * max(worst, tolerance if near and tolerance is not None else 0.0)


def _tolerance(plot: Plot, tolerance: float | None) -> None:
    if tolerance is None or tolerance > plot.y[1]:
        return
    for value in (-tolerance, tolerance):
        plot.level(value, "limit")
    plot.drawing.text(
        plot.left + 1.0, float(plot.down(tolerance)) - 0.8, f"f_{{pT}} {tolerance:g} µm", "small soft"
    )


def _curve(plot: Plot, flank: Flank, side: str) -> None:
    _range(plot, flank.cumulative_um)
    teeth = np.arange(1, len(flank.cumulative_um) + 1)
    plot.curve(teeth, flank.cumulative_um, f"trace {side}", id=f"{side}-cumulative")
    _dots(plot, flank.cumulative_um, side)
    _frame(plot, "F_{p}  [µm]", f"F_{{p}} {number(flank.cumulative_pitch_um)} µm", "tooth")


def _range(plot: Plot, values: Floats) -> None:
    """Shade from the smallest to the largest value: the deviation is what lies between."""
    finite = values[np.isfinite(values)]
    if finite.size:
        plot.band(float(finite.min()), float(finite.max()), "range")


def _dots(plot: Plot, values: Floats, side: str) -> None:
    radius = min(0.5, 0.3 * (plot.right - plot.left) / max(len(values), 1))
    for tooth, value in enumerate(values.tolist(), start=1):
        if np.isfinite(value):
            plot.drawing.disc(float(plot.across(tooth)), float(plot.down(value)), radius, f"dot {side}")


def _frame(plot: Plot, label: str, note: str, below: str) -> None:
    plot.level(0.0, "zero")
    plot.y_axis(label, room=GUTTER - 2.4)
    plot.x_axis(below, at=_teeth(plot))
    plot.drawing.text(plot.right, plot.top - 1.0, note, "small", anchor="end")


def _teeth(plot: Plot) -> tuple[float, ...]:
    """Numbers of the teeth that have room below the plot, 1 among them."""
    count = round(plot.x[1] - 0.7)
    room = (plot.right - plot.left) / 5.0
    if count <= room:
        return tuple(range(1, count + 1))
    return (1, *(value for value in ticks(0, count, max(int(room), 2)) if value > 1))
