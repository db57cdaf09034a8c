"""A complete regular gear, cut the quick way, or handed over."""

import math
from dataclasses import dataclass

import numpy as np

from twin.cutters.cutter import Cutter
from twin.cutting.blank import Blank
from twin.cutting.dual import Surface
from twin.cutting.engagement import StockCylinder, axes_apart, sway
from twin.cutting.field import DepthField
from twin.cutting.motion import CutterMotion
from twin.cutting.regular.chart import Frame, chart_along
from twin.cutting.regular.indexing import Indexing, find_indexing
from twin.cutting.regular.inside import look_inside
from twin.cutting.regular.irregular import IrregularError
from twin.cutting.regular.proved import prove
from twin.cutting.regular.screw import lay_out
from twin.cutting.regular.section import bend, section, spaced
from twin.cutting.regular.skin import skin
from twin.cutting.regular.steady import find_steady
from twin.cutting.regular.templates import Screwed
from twin.cutting.regular.tiles import Tiling
from twin.cutting.regular.tubes import tubes
from twin.cutting.sweep import Sweep

ROOT_SAG = 1.2e-3
"""[mm] by which a cell across the gap may sag where the root bends most, at a tolerance of 1 µm"""
MARK_SAG = 0.15e-3
"""[mm] by which a cell along the gap may sag in the feed marks, at a tolerance of 1 µm"""
RIM = 1.5
"""Cells by which the charts reach out of the blank."""
ROOM = 0.06
"""Share of the tooth height by which the section is searched further out than the blank: the hob's land is
an eighth of it above the tips."""
FINEST = 4e-3
"""Share of the tooth height below which no cell is chosen."""
ASTRAY = 0.1
"""Share of the shell's thickness by which a steady motion may stand off a screw."""
BUDGET = 420_000
"""Cells, of about 1.5 kB each at the peak, beyond which they are chosen coarser than the tolerance asks."""
LIMIT = 700_000
"""Cells beyond which a cut is left to the general way."""


@dataclass(frozen=True, slots=True)
class Regular:
    """The surface of a complete regular cut."""

    surface: Surface
    cell_mm: tuple[float, float]
    """across and along the gaps"""
    pairs: int
    """pairs of block and bite evaluated in the search"""
    coarser: float
    """times as long as the tolerance asks for, to keep within the memory"""


def regular_cut(
    blank: Blank,
    tools: tuple[tuple[Cutter, CutterMotion], ...],
    sweep: Sweep,
    *,
    tolerance_um: float = 1.0,
    cell_mm: float | None = None,
) -> Regular:
    """What the tools remove, if that is proved to be equal gaps and nothing else.

    The last of the tools indexes the gaps. `cell_mm` is the cell across the gaps, half of that along them;
    left out, it follows from the tolerance. Raises IrregularError, with what is missing, for any other cut.
    """
    cutter, motion = tools[-1]
    stock = StockCylinder.around(motion.mount, blank.radius, blank.z_range)
    indexing = find_indexing(cutter, motion, stock.radius)
    height = stock.radius - indexing.root
    room = max(0.7 * ROOM * height, RIM * cell_mm) if cell_mm else ROOM * height
    trial = Frame(indexing=indexing, stock=stock.radius, margin=room)
    found = section(sweep, trial, motion.mount, 0.5 * (stock.z_low + stock.z_high))
    across, along = cell_mm, 2.0 * (cell_mm or 0.0)
    if across is None:
        across = max(math.sqrt(8.0 * ROOT_SAG * tolerance_um / bend(found)), FINEST * height)
        along = math.sqrt(8.0 * MARK_SAG * tolerance_um * cutter.radius)
    coarser = 1.0
    ways = float(np.hypot(*np.diff(found, axis=0).T).sum()), stock.z_high - stock.z_low
    count = indexing.teeth * ways[0] / across * ways[1] / along
    if count > BUDGET and cell_mm is None:
        coarser = math.sqrt(count / BUDGET)
        across, along = min(across * coarser, ROOM * height / RIM), along * coarser
    thick = across
    tiling = Tiling.of((across, along), thick, cutter.radius, bend(found))
    frame = Frame(indexing=indexing, stock=stock.radius, margin=RIM * across)
    if min(_lowest(c, m, stock) for c, m in tools) < frame.core:
        raise IrregularError("something is cut below the root")
    surface = spaced(found, frame.outside, across, tiling.across)
    screwed = _screwed(sweep, motion, indexing, stock, (along, thick))
    if screwed is None:
        length = stock.z_high - stock.z_low + 2.0 * along
        count = tiling.along * math.ceil(length / (along * tiling.along))
        middle = 0.5 * (stock.z_low + stock.z_high)
        z = middle + along * (np.arange(count + 1, dtype=np.float64) - 0.5 * count)
        lift = np.zeros(indexing.teeth)
    else:
        z, lift = screwed.layout.z, screwed.layout.lift
    if indexing.teeth * len(z) * len(surface) > LIMIT:
        raise IrregularError("more cells than the memory allows")
    chart = chart_along(frame, motion.mount, surface, z, lift)
    look_inside(sweep, chart, thick)
    proved = prove(sweep, chart, tiling, thick, screwed)
    made = skin(sweep, proved, thick)
    return Regular(tubes(chart, made), (across, float(z[1] - z[0])), proved.pairs, coarser)


def _screwed(
    sweep: Sweep,
    motion: CutterMotion,
    indexing: Indexing,
    stock: StockCylinder,
    sizes: tuple[float, float],
) -> Screwed | None:
    """The screw of a steady motion, for cells so long and a shell so thick; None without one."""
    field = sweep.fields[-1]
    if not isinstance(field, DepthField):
        return None
    along, thick = sizes
    steady = find_steady(field, motion, indexing, stock, ASTRAY * thick)
    layout = steady and lay_out(indexing, steady, (stock.z_low, stock.z_high), along)
    return Screwed(steady=steady, layout=layout) if steady and layout else None


def _lowest(cutter: Cutter, motion: CutterMotion, stock: StockCylinder) -> float:
    """Smallest radius about the work spindle's axis that the tips may reach [mm]."""
    lean, far = sway(cutter, motion, stock)
    return float(axes_apart(motion).min()) - cutter.radius - lean * far
