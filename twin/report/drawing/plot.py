"""A rectangle of a drawing with two linear axes."""

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from twin.report.drawing.svg import Drawing
from twin.report.drawing.ticks import tick_text, ticks

Floats = NDArray[np.float64]
TICK = 0.9
"""length of a tick mark [mm]"""
TEXT = 2.3
"""height of the small type [mm]"""


class Plot:
    """Values drawn into the rectangle `left`, `top`, `width`, `height` [mm] of a drawing.

    `x` and `y` are the values at its left and right, at its bottom and top; an empty range is widened.
    """

    def __init__(
        self,
        drawing: Drawing,
        *,
        left: float,
        top: float,
        width: float,
        height: float,
        x: tuple[float, float],
        y: tuple[float, float],
    ) -> None:
        self.drawing = drawing
        self.left, self.top, self.right, self.bottom = left, top, left + width, top + height
        self.x, self.y = _widened(x), _widened(y)

    def across(self, value: ArrayLike) -> Floats:
        """Places [mm] of values along x."""
        low, high = self.x
        return self.left + (np.asarray(value, np.float64) - low) * ((self.right - self.left) / (high - low))

    def down(self, value: ArrayLike) -> Floats:
        """Places [mm] of values along y."""
        low, high = self.y
        return self.bottom - (np.asarray(value, np.float64) - low) * ((self.bottom - self.top) / (high - low))

    def curve(
        self, x: ArrayLike, y: ArrayLike, css: str, *, id: str = "", closed: bool = False, window: str = ""
    ) -> None:
        """Join values (n,) and (n,); a value that is not finite interrupts the line."""
        points = np.stack(np.broadcast_arrays(self.across(x), self.down(y)), axis=-1)
        self.drawing.line(points, css, id=id, closed=closed, window=window)

    def level(self, y: float, css: str, *, id: str = "") -> None:
        """Draw a line from left to right."""
        self.curve(self.x, (y, y), css, id=id)

    def upright(self, x: float, css: str, *, id: str = "") -> None:
        """Draw a line from bottom to top."""
        self.curve((x, x), self.y, css, id=id)

    def span(self, start: float, end: float, css: str, *, id: str = "") -> None:
        """Shade from one x to another over the whole height."""
        a, b = (float(np.clip(self.across(x), self.left, self.right)) for x in (start, end))
        self.drawing.rectangle(a, self.top, max(b - a, 0.15), self.bottom - self.top, css, id=id)

    def band(self, low: float, high: float, css: str, *, id: str = "") -> None:
        """Shade from one y to another over the whole width."""
        a, b = float(self.down(low)), float(self.down(high))
        self.drawing.rectangle(self.left, b, self.right - self.left, a - b, css, id=id)

    def bar(self, x: float, height: float, width: float, css: str, *, id: str = "") -> None:
        """Draw a bar from zero to `height`, `width` in values of x; nothing where it is not finite."""
        if not np.isfinite(height):
            return
        a, b = float(self.across(x - width / 2)), float(self.across(x + width / 2))
        foot, head = float(self.down(0.0)), float(self.down(height))
        self.drawing.rectangle(a, min(foot, head), b - a, abs(foot - head), css, id=id)

    def x_axis(self, label: str = "", *, most: int = 8, at: tuple[float, ...] | None = None) -> None:
        """Line, ticks and figures below."""
        marks, step = _marks(self.x, most, at)
        self.drawing.line([(self.left, self.bottom), (self.right, self.bottom)], "axis")
        for value in marks:
            x = float(self.across(value))
            self.drawing.line([(x, self.bottom), (x, self.bottom + TICK)], "axis")
            self.drawing.text(x, self.bottom + TICK + TEXT, tick_text(value, step), "small", anchor="middle")
        if label:
            middle = (self.left + self.right) / 2
            self.drawing.text(middle, self.bottom + TICK + 2.3 * TEXT, label, "small", anchor="middle")

    def y_axis(
        self, label: str = "", *, most: int = 5, at: tuple[float, ...] | None = None, room: float = 9.0
    ) -> None:
        """Line, ticks and figures at the left, and the label `room` [mm] out, upwards."""
        marks, step = _marks(self.y, most, at)
        self.drawing.line([(self.left, self.top), (self.left, self.bottom)], "axis")
        for value in marks:
            y = float(self.down(value))
            self.drawing.line([(self.left - TICK, y), (self.left, y)], "axis")
            self.drawing.text(
                self.left - TICK - 0.6, y + 0.36 * TEXT, tick_text(value, step), "small", anchor="end"
            )
        if label:
            x, y = self.left - room, (self.top + self.bottom) / 2
            self.drawing.text(x, y, label, "small", anchor="middle", turn=-90)

    def grid(self, *, most: int = 5, at: tuple[float, ...] | None = None) -> None:
        """Draw faint lines at the figures of y."""
        for value in _marks(self.y, most, at)[0]:
            self.level(value, "grid")


def _marks(
    span: tuple[float, float], most: int, at: tuple[float, ...] | None
) -> tuple[tuple[float, ...], float]:
    """Figures along an axis, and the step between them."""
    marks = ticks(*span, most) if at is None else at
    return marks, min((b - a for a, b in pairwise(marks)), default=1.0)


def _widened(span: tuple[float, float]) -> tuple[float, float]:
    low, high = span
    return (low, high) if low != high else (low - 0.5, high + 0.5)
