"""Single pitch bars and the cumulative pitch curve, left and right flanks side by side."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from twin.inspection.result import Flank, GearResult
from twin.report.scale import largest, number
from twin.report.style import BAND, GREY, LEFT, RIGHT, figure, styled, to_svg


def pitch_chart(gear: GearResult) -> str | None:
    """SVG of f_p and F_p over the teeth; None where no pitch was measured."""
    flanks = {"left": gear.left, "right": gear.right}
    curves = [values for flank in flanks.values() for values in (flank.pitch_um, flank.cumulative_um)]
    if not any(np.isfinite(values).any() for values in curves):
        return None
    with styled():
        sheet = figure(2.7)
        grid = sheet.subplots(
            2,
            2,
            sharex="col",
            sharey="row",
            gridspec_kw={
                "left": 0.075,
                "right": 0.985,
                "top": 0.93,
                "bottom": 0.10,
                "wspace": 0.09,
                "hspace": 0.22,
            },
        )
        for column, (side, flank), colour in zip(grid.T, flanks.items(), (LEFT, RIGHT), strict=True):
            column[0].set_title(f"{side.capitalize()} flank", color=colour)
            _bars(column[0], flank, colour, f"{side}-single")
            _curve(column[1], flank, colour, f"{side}-cumulative")
            column[1].set_xlabel("tooth", labelpad=1)
        for row, symbol in enumerate(("$f_p$ [µm]", "$F_p$ [µm]")):
            grid[row, 0].set_ylabel(symbol)
            reach = 1.4 * max(largest(values) for values in curves[row::2]) or 1.0
            grid[row, 0].set_ylim(-reach, reach)
            grid[row, 0].yaxis.set_major_locator(MaxNLocator(5))
        return to_svg(
            sheet, "pitch", "Single and cumulative pitch deviation of every tooth, left and right flanks"
        )


def _bars(axes: Axes, flank: Flank, colour: str, gid: str) -> None:
    teeth = np.arange(1, len(flank.pitch_um) + 1)
    for bar, tooth in zip(axes.bar(teeth, flank.pitch_um, 0.7, color=colour), teeth, strict=True):
        bar.set_gid(f"{gid}-{tooth}")
    _frame(axes, teeth, f"largest $f_p$  {number(flank.single_pitch_um)} µm")


def _curve(axes: Axes, flank: Flank, colour: str, gid: str) -> None:
    teeth = np.arange(1, len(flank.cumulative_um) + 1)
    finite = flank.cumulative_um[np.isfinite(flank.cumulative_um)]
    if finite.size:
        axes.axhspan(finite.min(), finite.max(), color=BAND, zorder=0)
    axes.plot(teeth, flank.cumulative_um, color=colour, marker="o", markersize=2, gid=gid)
    _frame(axes, teeth, f"$F_p$  {number(flank.cumulative_pitch_um)} µm")


def _frame(axes: Axes, teeth: np.ndarray, note: str) -> None:
    axes.axhline(0, color=GREY, linewidth=0.6)
    axes.set_xlim(0.3, max(len(teeth), 1) + 0.7)
    axes.xaxis.set_major_locator(MaxNLocator(10, integer=True))
    axes.text(1, 0.98, note, transform=axes.transAxes, ha="right", va="top")
