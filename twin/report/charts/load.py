"""What the cut does to the machine over time: power, torques of the spindles, forces on the slides."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from markupsafe import Markup

from twin.inspection.result import Floats
from twin.recording import Recording
from twin.report.charts.motion import envelope
from twin.report.drawing import Drawing, Plot

WIDTH = 180.0
"""[mm]"""
GUTTER = 13.5
"""left of each plot, for its figures [mm]"""
TALL, GAP = 20.0, 4.5
"""of each plot, and below it [mm]"""
TOP = 6.0
NEAR = 1.6
"""times the largest value that a limit may be, to be drawn"""
TEETH = 0.25
"""[s] about the largest power that the right-hand plots show"""


@dataclass(frozen=True, slots=True)
class _Row:
    name: str
    label: str
    values: Floats
    """(n,)"""
    limit: float = math.inf
    """to either side; drawn where values come near it"""


def load_chart(
    recording: Recording, rotary: frozenset[str], limits: Mapping[str, float] | None = None
) -> Markup | None:
    """SVG of power and forces: the whole run, and tooth by tooth about the largest power; None without.

    `limits`: what the drives have against them, by axis letter [N, N m].
    """
    load = recording.load
    if load is None or not load.power_w.any():
        return None
    rows = [_Row("power", "power  [W]", load.power_w)]
    for k, letter in enumerate(recording.axes):
        if load.axes[:, k].any():
            unit = "N m" if letter in rotary else "N"
            limit = (limits or {}).get(letter, math.inf)
            rows.append(_Row(f"load-{letter}", f"{letter}  [{unit}]", load.axes[:, k], limit))
    rows.append(_Row("give", "give  [µm]", np.linalg.norm(load.deflection_um, axis=1)))
    drawing = Drawing("load", WIDTH, TOP + len(rows) * (TALL + GAP) + 4.5)
    time = recording.time_s
    cutting = np.flatnonzero(load.power_w)
    most = float(time[int(np.argmax(load.power_w))])
    close = (np.abs(time - most) < TEETH / 2) & (np.abs(time - most) < (time[-1] - time[0]) / 4)
    spans = (
        (GUTTER, "While metal is cut", slice(max(int(cutting[0]) - 1, 0), int(cutting[-1]) + 2)),
        (WIDTH / 2 + GUTTER, "Tooth by tooth, about the largest power", np.flatnonzero(close)),
    )
    for left, title, part in spans:
        drawing.text(left, 3.6, title, "title")
        at = time[part]
        for number, row in enumerate(rows):
            values = row.values[part]
            low, high = min(float(values.min()), 0.0), max(float(values.max()), 0.0)
            bounds = []
            if row.limit < NEAR * high:
                bounds, high = [row.limit], max(high, row.limit)
            if -row.limit > NEAR * low:
                bounds, low = [*bounds, -row.limit], min(low, -row.limit)
            margin = 0.06 * (high - low) or 1.0
            plot = Plot(
                drawing,
                left=left,
                top=TOP + number * (TALL + GAP),
                width=WIDTH / 2 - GUTTER - 1.5,
                height=TALL,
                x=(float(at[0]), float(at[-1])),
                y=(low - (margin if low < 0 else 0.0), high + (margin if high > 0 else 0.0)),
            )
            plot.grid(most=4)
            plot.level(0.0, "zero")
            for bound in bounds:
                plot.level(bound, "limit", id=f"{row.name}-limit-{int(left)}")
            plot.curve(*envelope(at, values), "error", id=f"{row.name}-{int(left)}")
            plot.y_axis(row.label, most=4, room=GUTTER - 2.2)
            if number == len(rows) - 1:
                plot.x_axis("time [s]", most=6)
    return drawing.svg("Power, torques, slide forces and give of the mounts over time")
