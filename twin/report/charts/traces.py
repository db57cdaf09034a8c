"""Profile and helix traces in the layout of measuring machines.

Left flanks on the left, right flanks on the right; one trace a tooth about its own zero line, position
upwards, material outside the nominal away from the middle of the sheet. On paper the scales are those that
stand in the scale box.
"""

import math
from dataclasses import dataclass

import numpy as np
from markupsafe import Markup

from twin.inspection.involute import geometry
from twin.inspection.result import Flank, Floats, GearResult, Trace
from twin.report.drawing import Drawing, Plot
from twin.report.scale import largest, nice_floor, number, plain

MOST_TRACES = 8
"""of one flank that fit side by side"""
FEWEST_COLUMNS = 4
WIDTH, HEIGHT = 180.0, 60.0
"""of the drawing [mm]"""
MIDDLE = 25.0
"""width of the column between the panels [mm]"""
TOP, TALL = 6.5, 46.0
"""of the panels [mm]"""
BAND_AT_MOST = 8.0
"""times the largest trace that a tolerance band may be wide, to be drawn"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Kind:
    """What distinguishes a profile sheet from a helix sheet."""

    name: str
    """"profile" or "helix": the field of `Flank`, and the drawing's name"""
    position: str
    """name of the upward axis"""
    low: str
    """what lies at its lower end"""
    high: str
    total: str
    """symbol of the total deviation, whose tolerance is the band"""


PROFILE = Kind(name="profile", position="ξ  Ø  [mm]", low="root", high="tip", total="F_{α}")
HELIX = Kind(name="helix", position="z [mm]", low="chuck side", high="front face", total="F_{β}")


@dataclass(frozen=True, slots=True, kw_only=True)
class Scales:
    """How large the deviations and the flank are drawn: paper over part."""

    across: float
    """magnification of the deviation"""
    along: float
    """of the position"""
    tolerance_um: float | None
    """width of the tolerance band; None = not known, or too wide to be drawn"""


def profile_chart(gear: GearResult) -> Markup | None:
    """SVG of the profile traces; None where there are none."""
    return _chart(gear, PROFILE)


def helix_chart(gear: GearResult) -> Markup | None:
    """SVG of the helix traces; None where there are none."""
    return _chart(gear, HELIX)


def chosen_traces(flank: Flank, kind: Kind) -> tuple[Trace, ...]:
    """The traces that are drawn: all, or `MOST_TRACES` of them evenly spread."""
    traces: tuple[Trace, ...] = getattr(flank, kind.name)
    if len(traces) <= MOST_TRACES:
        return traces
    return tuple(traces[k] for k in np.linspace(0, len(traces) - 1, MOST_TRACES).round().astype(int))


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


def scales(
    traces: tuple[Trace, ...], pitch_mm: float, length_mm: float, tolerance_um: float | None
) -> Scales:
    """Round scales that give every trace its column of `pitch_mm`, and the tolerance band where it fits."""
    worst = max((2 * largest(t.deviation_um[evaluated(t)]) for t in traces), default=0.0)
    worst = max(worst, 0.5)
    if tolerance_um is not None and tolerance_um > BAND_AT_MOST * worst:
        tolerance_um = None
    widest = max(1.1 * worst, tolerance_um or 0.0)
    along = TALL / length_mm
    decade = 10.0 ** math.floor(math.log10(along))
    return Scales(
        across=nice_floor(0.92 * pitch_mm / (widest * 1e-3)),
        along=math.floor(along / decade + 1e-9) * decade,
        tolerance_um=tolerance_um,
    )


def _chart(gear: GearResult, kind: Kind) -> Markup | None:
    sides = {"left": chosen_traces(gear.left, kind), "right": chosen_traces(gear.right, kind)}
    every = sides["left"] + sides["right"]
    positions = np.concatenate([t.position for t in every]) if every else np.zeros(0)
    positions = positions[np.isfinite(positions)]
    if not positions.size:
        return None
    low, high = float(positions.min()), float(positions.max())
    panel = (WIDTH - MIDDLE) / 2
    pitch = panel / (max(len(sides["left"]), len(sides["right"]), FEWEST_COLUMNS) + 0.2)
    scale = scales(every, pitch, (high - low) or 1.0, gear.tolerances_um.get(f"{kind.name}_total"))
    reach = TALL / scale.along / 2
    span = ((low + high) / 2 - reach, (low + high) / 2 + reach)
    drawing = Drawing(kind.name, WIDTH, HEIGHT)
    for side, left, outward in (("left", 0.0, -1.0), ("right", WIDTH - panel, 1.0)):
        # values across are millimetres on paper, from the panel's left edge
        plot = Plot(drawing, left=left, top=TOP, width=panel, height=TALL, x=(0, panel), y=span)
        window = drawing.window(side, left, 0.0, panel, HEIGHT)
        _head(drawing, side, left, panel)
        for k, trace in enumerate(sides[side]):
            zero = (k + 0.6) * pitch
            _draw_trace(
                plot, trace, scale, zero=zero, outward=outward, name=f"{side}-{trace.tooth}", window=window
            )
            drawing.text(left + zero, HEIGHT - 1.5, str(trace.tooth), "strong", anchor="middle")
            for mark in trace.evaluation:
                plot.curve((zero - 0.42 * pitch, zero + 0.42 * pitch), mark, "mark")
        if not sides[side]:
            drawing.text(left + panel / 2, TOP + TALL / 2, "not measured", "soft", anchor="middle")
    middle = Plot(drawing, left=(WIDTH - MIDDLE) / 2, top=TOP, width=MIDDLE, height=TALL, x=(0, 1), y=span)
    _draw_middle(middle, kind, gear, every, scale)
    return drawing.svg(f"{kind.name.capitalize()} deviation of left and right flanks, one trace a tooth")


def _head(drawing: Drawing, side: str, left: float, panel: float) -> None:
    """Name of the panel, and to which side material stands out."""
    drawing.text(left + panel / 2, 3.2, f"{side.capitalize()} flank", f"title {side}", anchor="middle")
    if side == "left":
        drawing.text(left, 3.2, "← + material", "small soft")
        drawing.text(left, HEIGHT - 1.5, "tooth", "small soft")
    else:
        drawing.text(left + panel, 3.2, "+ material →", "small soft", anchor="end")
        drawing.text(left + panel, HEIGHT - 1.5, "tooth", "small soft", anchor="end")


def _draw_trace(
    plot: Plot, trace: Trace, scale: Scales, *, zero: float, outward: float, name: str, window: str
) -> None:
    """One trace about its zero line, `zero` [mm] from the panel's left edge."""
    used = evaluated(trace)
    per_um = outward * scale.across * 1e-3
    across = zero + per_um * trace.deviation_um
    if scale.tolerance_um is not None and used.any():
        inside = trace.deviation_um[used]
        middle = zero + per_um * (inside.min() + inside.max()) / 2
        half = scale.tolerance_um * scale.across * 1e-3 / 2
        start, end = sorted(trace.evaluation)
        plot.curve(
            (middle - half, middle + half, middle + half, middle - half),
            (start, start, end, end),
            "tolerance",
            id=f"{name}-band",
            closed=True,
        )
    plot.upright(zero, "zero")
    side = "left" if outward < 0 else "right"
    plot.curve(across, trace.position, f"trace {side} faint", id=name, window=window)
    plot.curve(np.where(used, across, np.nan), trace.position, f"trace {side}", window=window)
    line = mean_line(trace)
    if line is not None:
        plot.curve(zero + per_um * line[:, 1], line[:, 0], "mean", id=f"{name}-mean", window=window)


def _draw_middle(plot: Plot, kind: Kind, gear: GearResult, traces: tuple[Trace, ...], scale: Scales) -> None:
    """Between the panels: ends of the flank and of the evaluated range, and the scale box."""
    drawing, middle = plot.drawing, WIDTH / 2
    drawing.text(middle, TOP - 1.2, kind.high, "small soft", anchor="middle")
    drawing.text(middle, TOP + TALL + 2.6, kind.low, "small soft", anchor="middle")
    for low_end in (True, False):
        marks = {round((min if low_end else max)(trace.evaluation), 3) for trace in traces}
        for mark in sorted(filter(np.isfinite, marks)):
            plot.level(mark, "mark")
            text = _place(kind, gear, mark)
            drawing.text(
                middle, float(plot.down(mark)) + (-0.9 if low_end else 2.6), text, "small", anchor="middle"
            )
    drawing.text(middle, HEIGHT - 1.5, kind.position, "small soft", anchor="middle")
    _draw_scale_box(drawing, scale, middle, TOP + TALL / 2 - 5.0)
    if scale.tolerance_um is not None:
        text = kind.total[:-1] + f"T}} {plain(scale.tolerance_um)} µm"
        drawing.text(middle, TOP + TALL / 2 + 7.0, text, "small", anchor="middle")
        drawing.rectangle(middle - 4, TOP + TALL / 2 + 8.2, 8, 1.6, "tolerance")


def _draw_scale_box(drawing: Drawing, scale: Scales, x: float, y: float) -> None:
    """A box of round size in both directions, and the scales as ratios."""
    um, mm = nice_floor(12.0 / scale.across * 1e3), nice_floor(9.0 / scale.along)
    width, height = um * scale.across * 1e-3, mm * scale.along
    drawing.rectangle(x - width / 2, y - height / 2, width, height, "box", id="scale-box")
    drawing.text(x, y - height / 2 - 1.0, f"{um:g} µm  {ratio(scale.across)}", "small", anchor="middle")
    drawing.text(x, y + height / 2 + 2.8, f"{mm:g} mm  {ratio(scale.along)}", "small", anchor="middle")


def ratio(scale: float) -> str:
    """Word a drawing scale: 500:1, 1:2."""
    return f"{scale:g}:1" if scale >= 1 else f"1:{1 / scale:g}"


def _place(kind: Kind, gear: GearResult, position: float) -> str:
    """Name of a place on the flank: z, or the roll length and the diameter that it belongs to."""
    if kind is HELIX:
        return number(position, 2)
    return f"{number(position, 2)}  Ø {2 * float(geometry(gear.reference).radius_at(position)):.2f}"
