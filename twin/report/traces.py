"""Profile and helix traces in the layout of measuring machines.

Left flanks on the left, right flanks on the right; one trace a tooth about its own zero line, position
upwards, material outside the nominal away from the middle of the sheet.
"""

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from twin.inspection.result import Flank, Floats, GearResult, Trace
from twin.report.scale import largest, nice_ceiling, nice_floor, number
from twin.report.style import FAINT, GREY, INK, LEFT, RIGHT, figure, quiet, styled, to_svg

MOST_TRACES = 10
"""of one flank that fit side by side"""
FEWEST_COLUMNS = 4
MIDDLE = 0.32
"""width of the column between the panels, of a panel's"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Kind:
    """What distinguishes a profile sheet from a helix sheet."""

    name: str
    """"profile" or "helix": the field of `Flank`, and the start of the chart's ids"""
    position: str
    """label of the upward axis"""
    low: str
    """what lies at its lower end"""
    high: str
    symbols: tuple[str, str, str]
    """of slope, form and total deviation"""


PROFILE = Kind(
    name="profile",
    position="roll length ξ [mm]",
    low="root",
    high="tip",
    symbols=("$f_{Hα}$", "$f_{fα}$", "$F_α$"),
)
HELIX = Kind(
    name="helix",
    position="z [mm]",
    low="chuck side",
    high="front face",
    symbols=("$f_{Hβ}$", "$f_{fβ}$", "$F_β$"),
)


def profile_chart(gear: GearResult) -> str | None:
    """SVG of the profile traces; None where there are none."""
    return _chart(gear, PROFILE)


def helix_chart(gear: GearResult) -> str | None:
    """SVG of the helix traces; None where there are none."""
    return _chart(gear, HELIX)


def chosen_traces(flank: Flank, kind: Kind) -> tuple[Trace, ...]:
    """The traces that are drawn: all, or `MOST_TRACES` of them evenly spread."""
    traces: tuple[Trace, ...] = getattr(flank, kind.name)
    if len(traces) <= MOST_TRACES:
        return traces
    return tuple(traces[k] for k in np.linspace(0, len(traces) - 1, MOST_TRACES).round().astype(int))


def spacing_um(traces: tuple[Trace, ...]) -> float:
    """Distance between two zero lines: room for the largest deviation inside the evaluated ranges."""
    worst = max((largest(t.deviation_um[evaluated(t)]) for t in traces), default=0.0)
    return nice_ceiling(max(1.6 * worst, 1.0))


def evaluated(trace: Trace) -> np.ndarray:
    """(m,) which points of the trace lie in its evaluated range."""
    low, high = sorted(trace.evaluation)
    return (trace.position >= low) & (trace.position <= high) & np.isfinite(trace.deviation_um)


def mean_line(trace: Trace) -> Floats | None:
    """Least-squares line over the evaluated range: (2, 2) its ends, position and deviation; None below 2."""
    used = evaluated(trace)
    if np.count_nonzero(used) < 2:
        return None
    position = trace.position[used]
    ends = position[[position.argmin(), position.argmax()]]
    middle = position.mean()
    line = np.polyfit(position - middle, trace.deviation_um[used], 1) if np.ptp(position) > 0 else np.zeros(2)
    return np.stack([ends, np.polyval(line, ends - middle)], axis=-1)


def _chart(gear: GearResult, kind: Kind) -> str | None:
    sides = {"left": chosen_traces(gear.left, kind), "right": chosen_traces(gear.right, kind)}
    every = sides["left"] + sides["right"]
    positions = np.concatenate([t.position for t in every]) if every else np.zeros(0)
    if not np.isfinite(positions).any():
        return None
    low, high = float(np.nanmin(positions)), float(np.nanmax(positions))
    margin = 0.04 * (high - low) or 0.5
    spacing = spacing_um(every)
    width = (max(len(sides["left"]), len(sides["right"]), FEWEST_COLUMNS) + 0.5) * spacing
    with styled():
        sheet = figure(3.2)
        left, middle, right = sheet.subplots(
            1,
            3,
            sharey=True,
            width_ratios=(1, MIDDLE, 1),
            gridspec_kw={"left": 0.075, "right": 0.985, "wspace": 0.0, "top": 0.92, "bottom": 0.21},
        )
        left.set_ylim(low - margin, high + margin)
        for axes, side, colour, outward in ((left, "left", LEFT, -1.0), (right, "right", RIGHT, 1.0)):
            axes.set_title(f"{side.capitalize()} flank", color=colour)
            axes.set_xlim(-0.75 * spacing, width - 0.75 * spacing)
            quiet(axes, "left", "bottom")
            for k, trace in enumerate(sides[side]):
                _draw_trace(
                    axes,
                    trace,
                    zero=k * spacing,
                    spacing=spacing,
                    colour=colour,
                    outward=outward,
                    gid=f"{side}-{trace.tooth}",
                )
                values = (trace.slope_um, trace.form_um, trace.total_um)
                _write_column(axes, k * spacing, (str(trace.tooth), *(number(value) for value in values)))
            if not sides[side]:
                axes.text(0.5, 0.5, "not measured", transform=axes.transAxes, ha="center", color=GREY)
        _write_column(left, None, ("tooth", *(f"{symbol} µm" for symbol in kind.symbols)))
        _draw_middle(middle, kind, gear, every)
        middle.set_xlim(-width * MIDDLE / 2, width * MIDDLE / 2)
        _draw_scale_box(
            middle, nice_floor(0.5 * spacing), nice_floor(0.12 * (high - low) or 1.0), (low + high) / 2
        )
        return to_svg(
            sheet,
            kind.name,
            f"{kind.name.capitalize()} deviation of left and right flanks, one trace a tooth",
        )


def _draw_trace(
    axes: Axes, trace: Trace, *, zero: float, spacing: float, colour: str, outward: float, gid: str
) -> None:
    used = evaluated(trace)
    across = zero + outward * trace.deviation_um
    axes.axvline(zero, color=FAINT, linewidth=0.6, zorder=0)
    axes.plot(across, trace.position, color=colour, linewidth=0.5, alpha=0.45, gid=gid)
    axes.plot(np.where(used, across, np.nan), trace.position, color=colour, linewidth=0.9)
    line = mean_line(trace)
    if line is not None:
        ends = zero + outward * line[:, 1]
        axes.plot(ends, line[:, 0], color=INK, linewidth=0.6, dashes=(4, 2), gid=f"{gid}-mean")
    for mark in trace.evaluation:
        axes.plot([zero - 0.42 * spacing, zero + 0.42 * spacing], [mark, mark], color=GREY, linewidth=0.5)


def _write_column(axes: Axes, at: float | None, texts: tuple[str, ...]) -> None:
    """Texts below the panel, under the zero line `at`, or as row names at the panel's left end."""
    for row, text in enumerate(texts):
        axes.annotate(
            text,
            (0 if at is None else at, 0),
            (-38 if at is None else 0, -9 - 9.5 * row),
            xycoords=("axes fraction" if at is None else "data", "axes fraction"),
            textcoords="offset points",
            ha="left" if at is None else "center",
            va="center",
            color=GREY if at is None else INK,
            fontweight="bold" if row == 0 and at is not None else "normal",
        )


def _draw_middle(axes: Axes, kind: Kind, gear: GearResult, traces: tuple[Trace, ...]) -> None:
    """Between the panels: the ends of the evaluated range, and what lies at the ends of the flank."""
    quiet(axes, "left", "bottom")
    for text, at, gap, align in ((kind.high, 1.0, 3, "bottom"), (kind.low, 0.0, -3, "top")):
        axes.annotate(
            text,
            (0.5, at),
            (0, gap),
            xycoords="axes fraction",
            textcoords="offset points",
            ha="center",
            va=align,
            color=GREY,
        )
    axes.annotate(
        kind.position,
        (0.5, 0),
        (0, -20),
        xycoords="axes fraction",
        textcoords="offset points",
        ha="center",
        color=GREY,
    )
    for low_end in (True, False):
        marks = {round((min if low_end else max)(trace.evaluation), 3) for trace in traces}
        for mark in sorted(filter(np.isfinite, marks)):
            axes.axhline(mark, color=GREY, linewidth=0.5)
            axes.annotate(
                _place(kind, gear, mark),
                (0, mark),
                (0, 3 if low_end else -3),
                textcoords="offset points",
                ha="center",
                va="bottom" if low_end else "top",
                fontsize=6.0,
            )


def _draw_scale_box(axes: Axes, across_um: float, along_mm: float, centre: float) -> None:
    box = Rectangle(
        (-across_um / 2, centre - along_mm / 2),
        across_um,
        along_mm,
        facecolor="none",
        edgecolor=INK,
        linewidth=0.6,
        gid="scale-box",
    )
    axes.add_patch(box)
    for text, at, gap in (
        (f"{across_um:g} µm", centre + along_mm / 2, 3),
        (f"{along_mm:g} mm", centre - along_mm / 2, -3),
    ):
        axes.annotate(
            text,
            (0, at),
            (0, gap),
            textcoords="offset points",
            ha="center",
            va="bottom" if gap > 0 else "top",
        )


def _place(kind: Kind, gear: GearResult, position: float) -> str:
    """Name of a place on the flank: z, or the roll length and the diameter that it belongs to."""
    if kind is HELIX:
        return number(position, 2)
    reference = gear.reference
    cosine = np.cos(np.radians(reference.helix_angle_deg))
    transverse = np.arctan(np.tan(np.radians(reference.normal_pressure_angle_deg)) / cosine)
    base = reference.number_of_teeth * reference.normal_module_mm / cosine * np.cos(transverse)
    return f"{number(position, 2)}\nØ {2 * np.hypot(position, base / 2):.2f}"
