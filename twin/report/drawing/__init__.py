"""Pictures as SVG of our own: lengths in millimetres on paper, looks in the style sheet.

`Drawing` holds the elements, `standalone` makes a file of it, `Plot` is a rectangle of it with two linear
axes, `ticks` finds round figures.
"""

from twin.report.drawing.plot import Plot
from twin.report.drawing.svg import Drawing, standalone
from twin.report.drawing.ticks import ticks

__all__ = ["Drawing", "Plot", "standalone", "ticks"]
