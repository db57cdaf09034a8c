"""An SVG picture under construction."""

import math
import re
from html import escape

import numpy as np
from markupsafe import Markup
from numpy.typing import ArrayLike

_SUBSCRIPT = re.compile(r"_\{([^}]*)\}")
_DROP = 0.55
"""by which a subscript stands below the line [mm]"""


def standalone(svg: Markup, style: str) -> str:
    """A picture as a file of its own, on white, with a style sheet (`<style>` and all)."""
    head, rest = str(svg).split(">", 1)
    ground = '<rect width="100%" height="100%" fill="#fff"/>'
    return f'{head} xmlns="http://www.w3.org/2000/svg">{style}{ground}{rest}\n'


class Drawing:
    """A picture of some width and height [mm on paper], x to the right and y downwards from its upper left.

    Elements carry class names only: colours and line widths stand in the page's style sheet, `charts.css`,
    so that light, dark and print have their own. `name` begins every id, so that pictures do not disturb
    one another on a page.
    """

    def __init__(self, name: str, width: float, height: float) -> None:
        self.name, self.width, self.height = name, width, height
        self._parts: list[str] = []

    def line(
        self, points: ArrayLike, css: str, *, id: str = "", closed: bool = False, window: str = ""
    ) -> None:
        """Join points (n, 2) [mm]; a point that is not finite interrupts the line.

        Only what lies in the `window`, if one is named, is seen.
        """
        path = _path(np.asarray(points, dtype=np.float64).reshape(-1, 2), closed=closed)
        if path:
            self._add("path", css, id, d=path, **{"clip-path": f"url(#{window})"} if window else {})

    def window(self, id: str, left: float, top: float, width: float, height: float) -> str:
        """Make a rectangle [mm] beyond which lines are cut off; return its name."""
        name = f"{self.name}-{id}-window"
        box = f'<rect x="{left:.2f}" y="{top:.2f}" width="{width:.2f}" height="{height:.2f}"/>'
        self._parts.append(f'<clipPath id="{name}">{box}</clipPath>')
        return name

    def rectangle(
        self, left: float, top: float, width: float, height: float, css: str, *, id: str = ""
    ) -> None:
        """Draw a rectangle [mm]."""
        self._add("rect", css, id, x=left, y=top, width=width, height=height)

    def disc(self, x: float, y: float, radius: float, css: str, *, id: str = "") -> None:
        """Draw a circle [mm]."""
        self._add("circle", css, id, cx=x, cy=y, r=radius)

    def image(self, left: float, top: float, width: float, height: float, url: str) -> None:
        """Place a picture element by element, unsmoothed."""
        self._add("image", "pixels", "", x=left, y=top, width=width, height=height, href=url)

    def text(
        self, x: float, y: float, text: str, css: str = "", *, anchor: str = "start", turn: float = 0
    ) -> None:
        """Write at a base line [mm], `turn` degrees clockwise; `_{…}` stands lower."""
        place = f' transform="rotate({turn:g} {x:.2f} {y:.2f})"' if turn else ""
        where = "" if anchor == "start" else f' text-anchor="{anchor}"'
        style = f' class="{css}"' if css else ""
        self._parts.append(f'<text x="{x:.2f}" y="{y:.2f}"{where}{style}{place}>{_lowered(text)}</text>')

    def svg(self, description: str) -> Markup:
        """Return the picture for the inside of a page: as wide as its place, on paper in its true size."""
        return Markup(
            f'<svg viewBox="0 0 {self.width:g} {self.height:g}" style="--width:{self.width:g}mm" '
            f'id="{self.name}" role="img" aria-label="{escape(description)}">{"".join(self._parts)}</svg>'
        )

    def _add(self, tag: str, css: str, id: str, **attributes: float | str) -> None:
        named = f' id="{self.name}-{id}"' if id else ""
        told = "".join(
            f' {key}="{escape(value) if isinstance(value, str) else f"{value:.2f}"}"'
            for key, value in attributes.items()
        )
        self._parts.append(f'<{tag}{named} class="{css}"{told}/>')


def _path(points: np.ndarray, *, closed: bool) -> str:
    """SVG path data of points (n, 2), a new piece after each gap."""
    words = []
    command = "M"
    for x, y in points.tolist():
        if math.isfinite(x) and math.isfinite(y):
            words.append(f"{command}{x:.2f} {y:.2f}")
            command = "L"
        else:
            command = "M"
    return "".join(words) + ("Z" if closed and words else "")


def _lowered(text: str) -> str:
    """Escaped text with its subscripts as spans, and the line taken up again behind each."""
    plain, *rest = _SUBSCRIPT.split(text)
    words = [escape(plain)]
    for below, after in zip(rest[::2], rest[1::2], strict=True):
        words.append(f'<tspan class="sub" dy="{_DROP}">{escape(below)}</tspan>')
        if after:
            words.append(f'<tspan dy="-{_DROP}">{escape(after)}</tspan>')
    return "".join(words)
