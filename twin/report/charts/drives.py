"""Step and frequency response of every drive: what MuJoCo measured over the transfer function of its loop."""

from collections.abc import Sequence

import numpy as np
from markupsafe import Markup

from twin.machine.response import Response
from twin.report.drawing import Drawing, Plot, standalone

WIDTH = 180.0
"""[mm]"""
TOP, TALL, PITCH = 14.0, 27.0, 43.0
"""of the first row, of a plot, and from row to row [mm]"""
GUTTER = 12.0
"""left of each plot, for its figures [mm]"""
MARGIN = 2.0
WIDE = WIDTH / 3 - GUTTER - 3.0
SHOWN_S = 0.1
"""[s] of the step"""
DECADES = (1.0, 10.0, 100.0)
LOWEST_DB, LOWEST_DEG = -30.0, -225.0
MARKS = 15
"""measured points of a step that are marked"""
FINE = 20
"""of the points of a transfer function, every so many are drawn"""
LOOKS = ("bare", "whole")
"""of the loop without feed-forward, and as it is"""
STYLE = """<style>text{font:2.6px sans-serif;fill:#1f2933}text.small{font-size:2.3px}
text.title{font-size:2.9px;font-weight:700}path{fill:none}.axis{stroke:#52606d;stroke-width:.18}
.grid{stroke:#d9e0e7;stroke-width:.15}.bare{stroke:#a92a22;stroke-width:.32}.whole{stroke:#1f5fa8;stroke-width:.32}
circle.bare{fill:#a92a22;stroke:none}circle.whole{fill:#1f5fa8;stroke:none}</style>"""


def drives_chart(pairs: Sequence[tuple[Response, Response]]) -> Markup:
    """SVG with a row an axis: step, amplitude and phase; lines the law, dots what MuJoCo did."""
    drawing = Drawing("drives", WIDTH, TOP + PITCH * len(pairs) - 6.0)
    for x, look, words in (
        (MARGIN, "bare", "without feed-forward"),
        (46.0, "whole", "with feed-forward as set"),
    ):
        drawing.line([(x, 3.0), (x + 6.0, 3.0)], look)
        drawing.disc(x + 3.0, 3.0, 0.55, look)
        drawing.text(x + 7.5, 3.8, words)
    drawing.text(92.0, 3.8, "lines: the closed loop's transfer function; dots: measured in MuJoCo", "small")
    for number, pair in enumerate(pairs):
        top = TOP + PITCH * number
        drive = pair[1].drive.drive
        words = (
            f"{pair[0].joint.replace('_', ' ')}   {pair[0].inertia:.4g} {pair[0].unit}, "
            f"Kv {drive.position_gain:g} 1/s, velocity loop {drive.velocity_gain:g} 1/s"
        )
        drawing.text(MARGIN, top - 3.0, words, "title")
        _steps(drawing, pair, top)
        _amplitudes(drawing, pair, top)
        _phases(drawing, pair, top)
    return drawing.svg("Step and frequency response of every axis, measured and by its transfer function")


def drives_file(pairs: Sequence[tuple[Response, Response]]) -> str:
    """The same as a file of its own."""
    return standalone(drives_chart(pairs), STYLE)


def _plot(drawing: Drawing, column: int, top: float, x: tuple[float, float], y: tuple[float, float]) -> Plot:
    left = GUTTER + column * WIDTH / 3
    return Plot(drawing, left=left, top=top, width=WIDE, height=TALL, x=x, y=y)


def _steps(drawing: Drawing, pair: tuple[Response, Response], top: float) -> None:
    plot = _plot(drawing, 0, top, (0.0, 1e3 * SHOWN_S), (0.0, 1.1))
    plot.grid(at=(0.0, 0.5, 1.0))
    for found, look in zip(pair, LOOKS, strict=True):
        shown = found.time_s <= SHOWN_S + 1e-9
        time = np.concatenate([[0.0], 1e3 * found.time_s[shown]])
        plot.curve(time, np.concatenate([[0.0], found.step_law[shown]]), look)
        each = max(1, np.count_nonzero(shown) // MARKS)
        _dots(plot, time[1::each], found.step[shown][::each], look)
    plot.y_axis("step", at=(0.0, 0.5, 1.0), room=GUTTER - 2.2)
    plot.x_axis("time [ms]", most=6)


def _amplitudes(drawing: Drawing, pair: tuple[Response, Response], top: float) -> None:
    plot = _plot(drawing, 1, top, _decades(pair[0]), (LOWEST_DB, 5.0))
    plot.grid(at=(-30.0, -20.0, -10.0, -3.0, 0.0))
    _frequencies(plot)
    plot.y_axis("amplitude [dB]", at=(-30.0, -20.0, -10.0, 0.0), room=GUTTER - 2.2)
    for found, look in zip(pair, LOOKS, strict=True):
        for hertz, answer, mark in (
            (found.law_hertz, found.law, False),
            (found.hertz, found.measured, True),
        ):
            level = 20.0 * np.log10(np.maximum(np.abs(answer), 1e-9))
            (_dots if mark else _line)(plot, np.log10(hertz), level, look)


def _phases(drawing: Drawing, pair: tuple[Response, Response], top: float) -> None:
    plot = _plot(drawing, 2, top, _decades(pair[0]), (LOWEST_DEG, 20.0))
    plot.grid(at=(-180.0, -90.0, 0.0))
    _frequencies(plot)
    plot.y_axis("phase [°]", at=(-180.0, -90.0, 0.0), room=GUTTER - 2.2)
    for found, look in zip(pair, LOOKS, strict=True):
        law = np.degrees(np.unwrap(np.angle(found.law)))
        _line(plot, np.log10(found.law_hertz), law, look)
        # of the turns that an angle leaves open, those of the law
        measured = np.degrees(np.angle(found.measured))
        near = np.interp(found.hertz, found.law_hertz, law)
        _dots(plot, np.log10(found.hertz), measured + 360.0 * np.round((near - measured) / 360.0), look)


def _decades(found: Response) -> tuple[float, float]:
    """From 1 Hz to the highest frequency, as logarithms."""
    return 0.0, float(np.log10(found.law_hertz[-1]))


def _frequencies(plot: Plot) -> None:
    """The axis below, over the logarithm of the frequency."""
    plot.x_axis("frequency [Hz]", at=())
    for decade in DECADES:
        x = float(plot.across(np.log10(decade)))
        plot.drawing.line([(x, plot.bottom), (x, plot.bottom + 0.9)], "axis")
        plot.drawing.text(x, plot.bottom + 3.2, f"{decade:g}", "small", anchor="middle")


def _line(plot: Plot, x: np.ndarray, y: np.ndarray, look: str) -> None:
    inside = np.flatnonzero((x >= plot.x[0]) & (y >= plot.y[0]) & (y <= plot.y[1]))
    shown = np.union1d(inside[::FINE], inside[-1:])
    plot.curve(x[shown], y[shown], look)


def _dots(plot: Plot, x: np.ndarray, y: np.ndarray, look: str) -> None:
    for a, b in zip(x.tolist(), y.tolist(), strict=True):
        if plot.x[0] <= a <= plot.x[1] and plot.y[0] <= b <= plot.y[1]:
            plot.drawing.disc(float(plot.across(a)), float(plot.down(b)), 0.5, look)
