"""Pictures of a compensation: what was touched, and what every flank lost."""

import numpy as np
from markupsafe import Markup
from numpy.typing import NDArray

from twin.compensation.measure import Measurement
from twin.compensation.removal import Removal
from twin.report.drawing import Drawing, Plot

Floats = NDArray[np.float64]

WIDTH, LEFT = 180.0, 13.0
"""[mm] of a picture, and left of its plots"""
TALL, SMALL = 34.0, 20.0
"""[mm] of the plots"""
ROOM = 1.15
"""of the largest value to both sides"""


def touch_chart(measured: Measurement) -> Markup:
    """The touches over the angle of C with what the fitted circle says, and what is left between them."""
    circle = measured.centre.geometric
    c = np.radians(measured.angle_deg)
    at = circle.phase + np.linspace(0.0, 2.0 * np.pi, 361)
    wave = 1e3 * circle.eccentricity * np.cos(at)
    turned = circle.phase + c
    rest = 1e3 * circle.residuals(measured.centre.points)
    touched = 1e3 * circle.eccentricity * np.cos(turned) + rest
    drawing = Drawing("touches", WIDTH, TALL + SMALL + 26.0)
    x = (0.0, 360.0)
    reach = ROOM * max(float(np.abs(touched).max()), 1e-3)
    plot = Plot(drawing, left=LEFT, top=5.0, width=WIDTH - LEFT - 2.0, height=TALL, x=x, y=(-reach, reach))
    plot.level(0.0, "zero")
    plot.curve(np.linspace(0.0, 360.0, 361), wave, "trace left")
    _dots(plot, measured.angle_deg, touched, "both")
    plot.y_axis("band  [µm]", room=LEFT - 3.0)
    plot.x_axis(at=tuple(range(0, 361, 30)))
    small = ROOM * max(float(np.abs(rest).max()), 1e-3)
    top = TALL + 14.0
    plot = Plot(drawing, left=LEFT, top=top, width=WIDTH - LEFT - 2.0, height=SMALL, x=x, y=(-small, small))
    plot.level(0.0, "zero")
    for angle, value in zip(measured.angle_deg.tolist(), rest.tolist(), strict=True):
        plot.curve((angle, angle), (0.0, value), "trace left")
    _dots(plot, measured.angle_deg, rest, "both")
    plot.y_axis("rest  [µm]", room=LEFT - 3.0, most=4)
    plot.x_axis("angle of C  [°]", at=tuple(range(0, 361, 30)))
    return drawing.svg("Touches of the band over the angle of C, and their distances from the fitted circle")


def removal_chart(before: Removal, after: Removal, stock_um: float) -> Markup:
    """Least to most stock removed from every flank, both gears, left and right flanks one above the other."""
    drawing = Drawing("removal", WIDTH, 2.0 * (TALL + 14.0))
    for row, side in enumerate(("left", "right")):
        ranges = [
            [1e3 * part for part in (one.left if side == "left" else one.right)] for one in (before, after)
        ]
        top = max(float(np.nanmax(most)) for _, most in ranges)
        low = min(0.0, *(float(np.nanmin(least)) for least, _ in ranges))
        z = len(ranges[0][0])
        plot = Plot(
            drawing,
            left=LEFT,
            top=6.0 + row * (TALL + 14.0),
            width=WIDTH - LEFT - 2.0,
            height=TALL,
            x=(0.3, z + 0.7),
            y=(low, ROOM * max(top, stock_um)),
        )
        plot.grid()
        plot.level(stock_um, "limit")
        for shift, css, (least, most) in ((-0.2, "faint", ranges[0]), (0.2, "", ranges[1])):
            for gap, (a, b) in enumerate(zip(least.tolist(), most.tolist(), strict=True), start=1):
                plot.curve((gap + shift, gap + shift), (0.0, a), f"removed {side} {css}")
                plot.curve((gap + shift, gap + shift), (a, b), f"spread {css}")
        plot.y_axis("removed  [µm]", room=LEFT - 3.0)
        step = max(1, z // 15)
        plot.x_axis("gap" if row else "", at=tuple(range(1, z + 1, step)))
        drawing.text(LEFT, 4.5 + row * (TALL + 14.0), f"{side.capitalize()} flanks", f"title {side}")
    return drawing.svg("Stock removed from every flank before and after compensation")


def _dots(plot: Plot, x: Floats, y: Floats, css: str) -> None:
    for a, b in zip(np.asarray(plot.across(x)), np.asarray(plot.down(y)), strict=True):
        plot.drawing.disc(float(a), float(b), 0.7, f"dot {css}")
