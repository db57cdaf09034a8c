"""One look for all charts: figures without global state, SVG that is the same byte for byte."""

import io
import re
from contextlib import AbstractContextManager
from html import escape
from typing import Any

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.typing import RcKeyType

WIDTH_IN = 7.2
"""of every chart: the text width of an A4 page"""
INK = "#1f2933"
GREY = "#7b8794"
FAINT = "#d5dbe1"
LEFT = "#1f5fa8"
"""left flanks, setpoints"""
RIGHT = "#b3541e"
"""right flanks, actual values"""
BAND = "#eef3f8"

RC: dict[RcKeyType, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 7.0,
    "text.color": INK,
    "axes.edgecolor": GREY,
    "axes.labelcolor": INK,
    "axes.labelsize": 7.0,
    "axes.titlesize": 8.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.unicode_minus": True,
    "xtick.color": GREY,
    "ytick.color": GREY,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.labelsize": 6.5,
    "ytick.labelsize": 6.5,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "grid.color": FAINT,
    "grid.linewidth": 0.5,
    "lines.linewidth": 0.9,
    "lines.solid_joinstyle": "round",
    "legend.frameon": False,
    "legend.fontsize": 6.5,
    "path.simplify": False,
    "svg.fonttype": "path",
    "svg.hashsalt": "hobtwin",
    "figure.dpi": 72,
}
"""matplotlib settings; glyphs as paths, so that the page looks alike without any font installed"""

_PROLOGUE = re.compile(r"^.*?(?=<svg)", re.DOTALL)
_METADATA = re.compile(r"\s*<metadata>.*?</metadata>", re.DOTALL)
_SIZE = re.compile(r' (?:width|height)="[\d.]+pt"')
_LONG_NUMBER = re.compile(r"(?<=\.\d\d)\d+")
_PATH = re.compile(r'\bd="[^"]*"')


def figure(height_in: float) -> Figure:
    """An empty figure as wide as the page; draw it inside `matplotlib.rc_context(RC)`."""
    return Figure(figsize=(WIDTH_IN, height_in))


def to_svg(figure: Figure, name: str, description: str) -> str:
    """Inline SVG without size, prologue or metadata; every id starts with `name`, numbers end at 0.01 pt."""
    buffer = io.StringIO()
    figure.savefig(
        buffer, format="svg", metadata={"Date": None, "Creator": None, "Format": None, "Type": None}
    )
    svg = _METADATA.sub("", _PROLOGUE.sub("", buffer.getvalue()))
    head, body = svg.split(">", 1)
    head = _SIZE.sub("", head) + f' role="img" aria-label="{escape(description)}"'
    body = _PATH.sub(lambda path: _LONG_NUMBER.sub("", path[0]), body)
    for reference in (' id="', 'href="#', "url(#"):
        body = body.replace(reference, f"{reference}{name}-")
    return f"{head}>{body}".strip()


def quiet(axes: Axes, *sides: str) -> None:
    """Take away an axis's spines and ticks on the named sides."""
    for side in sides:
        axes.spines[side].set_visible(False)
    if "left" in sides:
        axes.tick_params(left=False, labelleft=False)
    if "bottom" in sides:
        axes.tick_params(bottom=False, labelbottom=False)


def styled() -> AbstractContextManager[None]:
    """Apply the look for the time of a `with` block."""
    return matplotlib.rc_context(RC)
