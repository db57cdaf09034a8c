"""The table below the traces: every figure of every tooth, what it comes to, and what is allowed."""

from dataclasses import dataclass

from twin.inspection.result import Flank, GearResult, Trace
from twin.report import tables
from twin.report.charts.traces import Kind, chosen_traces
from twin.report.scale import MISSING, number, plain

ITEMS = {
    "profile": (
        ("slope", "f_{Hα}", "slope"),
        ("form", "f_{fα}", "form"),
        ("total", "F_{α}", "total"),
        ("crowning", "C_{α}", "crowning"),
    ),
    "helix": (
        ("slope", "f_{Hβ}", "slope"),
        ("form", "f_{fβ}", "form"),
        ("total", "F_{β}", "total"),
        ("crowning", "C_{β}", "crowning"),
    ),
}
"""kind -> figure, symbol, name"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cell:
    """A figure, worded."""

    text: str
    out: bool = False
    """beyond the tolerance"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Half:
    """The figures of one flank in one row."""

    teeth: tuple[Cell, ...]
    result: Cell
    """mean of slopes and crownings, the largest of the others"""
    filtered: str
    """the same behind the Gaussian filter"""
    uncertainty: str
    """how much of it the mesh's facets can make"""


@dataclass(frozen=True, slots=True, kw_only=True)
class TraceRow:
    """One item of both flanks."""

    symbol: str
    name: str
    left: Half
    right: Half
    allowed: str
    reached: str


@dataclass(frozen=True, slots=True, kw_only=True)
class TraceTable:
    """All items of profile or helix."""

    left_teeth: tuple[int, ...]
    right_teeth: tuple[int, ...]
    rows: tuple[TraceRow, ...]


def trace_table(gear: GearResult, kind: Kind) -> TraceTable:
    """Word the figures [µm] of the traces that are drawn."""
    left, right = chosen_traces(gear.left, kind), chosen_traces(gear.right, kind)
    rows = []
    for figure, symbol, name in ITEMS[kind.name]:
        item = f"{kind.name}_{figure}"
        tolerance = gear.tolerances_um.get(item)
        rows.append(
            TraceRow(
                symbol=symbol,
                name=name,
                left=_half(gear.left, left, item, figure, tolerance),
                right=_half(gear.right, right, item, figure, tolerance),
                allowed=plain(tolerance),
                reached=tables.class_reached(gear, item),
            )
        )
    return TraceTable(
        left_teeth=tuple(trace.tooth for trace in left),
        right_teeth=tuple(trace.tooth for trace in right),
        rows=tuple(rows),
    )


def _half(flank: Flank, traces: tuple[Trace, ...], item: str, figure: str, tolerance: float | None) -> Half:
    field = f"{item}_um"
    uncertainty = flank.uncertainty.get(field)
    return Half(
        teeth=tuple(_cell(getattr(trace, f"{figure}_um"), tolerance) for trace in traces),
        result=_cell(getattr(flank, field), tolerance),
        filtered=number(flank.filtered.get(field)),
        uncertainty=MISSING if uncertainty is None else f"±{number(uncertainty, 2)}",
    )


def _cell(value: float | None, tolerance: float | None) -> Cell:
    return Cell(
        text=number(value), out=tolerance is not None and value is not None and abs(value) > tolerance
    )
