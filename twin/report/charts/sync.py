"""The gear box at constant speed: its error over the last turn of the work, and the orders in it."""

import numpy as np
from markupsafe import Markup

from twin.report.charts.motion import envelope
from twin.report.drawing import Drawing, Plot
from twin.report.scale import largest
from twin.sync import Spectrum

WIDTH = 180.0
"""[mm]"""
GUTTER = 13.5
"""left of each plot, for its figures [mm]"""
TALL = 34.0
"""of each plot [mm]"""
TOOL_ORDERS = 3.4
"""orders of the tool that the spectrum shows"""


def sync_chart(found: Spectrum) -> Markup:
    """SVG of the error over the last turn of the work, and of its spectrum up to the third order of the
    tool."""
    drawing = Drawing("sync", WIDTH, 6.0 + TALL + 9.0)
    left, right = GUTTER, WIDTH / 2 + GUTTER
    width = WIDTH / 2 - GUTTER - 1.5
    drawing.text(left, 3.4, "Error over the last turn of the work", "title")
    drawing.text(right, 3.4, "Orders in it", "title")
    turn = found.turn_arcsec
    angle, error = envelope(np.linspace(0.0, 360.0, len(turn)), turn)
    low, high = float(error.min()), float(error.max())
    margin = 0.08 * (high - low) or 1.0
    plot = Plot(
        drawing,
        left=left,
        top=6.0,
        width=width,
        height=TALL,
        x=(0.0, 360.0),
        y=(low - margin, high + margin),
    )
    plot.grid()
    if plot.y[0] < 0.0 < plot.y[1]:
        plot.level(0.0, "zero")
    plot.curve(angle, error, "error", id="turn")
    plot.y_axis("error  [″]", room=GUTTER - 2.2)
    plot.x_axis("work angle [°]", at=(0.0, 90.0, 180.0, 270.0, 360.0))
    last = min(TOOL_ORDERS * max(found.tool_turns, 1.0), float(found.order[-1]))
    shown = found.order <= last
    top = largest(found.amplitude_arcsec[shown]) or 1.0
    plot = Plot(drawing, left=right, top=6.0, width=width, height=TALL, x=(0.0, last), y=(0.0, 1.12 * top))
    plot.grid()
    for order in range(1, int(last / found.tool_turns) + 1):
        at = order * found.tool_turns
        plot.upright(at, "zero")
        x = float(plot.across(at)) + 0.6
        drawing.text(x, 8.0, f"tool × {order}" if order > 1 else "tool", "small soft")
    at, amplitude = envelope(found.order[shown], found.amplitude_arcsec[shown])
    plot.curve(np.concatenate([[0.0], at]), np.concatenate([[0.0], amplitude]), "error", id="orders")
    plot.y_axis("amplitude  [″]", room=GUTTER - 2.2)
    plot.x_axis("periods per turn of the work")
    return drawing.svg("Synchronisation error over one turn of the work, and its spectrum by orders")
