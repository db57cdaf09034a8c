"""A comparison for the terminal and for machines."""

from typing import Any

from twin.comparison.changes import Change
from twin.comparison.compare import Comparison, Extreme, Spread
from twin.inspection.keys import Figure


def text_lines(found: Comparison, *, tolerance_um: float | None = None) -> list[str]:
    """Say how far the surfaces differ and where, then what changed."""
    said = [f"note: {note}" for note in found.notes]
    said += ["Surface of A against B (+ = A has more material)", *_spread(found.surface)]
    said += ["Surface of B against A (+ = B has more material)", *_spread(found.reverse)]
    changed = [change for change in found.changes if change.changed]
    if not changed:
        said.append(f"Figures: none of {len(found.changes)} changed by more than the meshes' facets can make")
    else:
        said.append(f"Figures: {len(changed)} of {len(found.changes)} changed")
        said += columns([("", "A", "B", "A − B", "± facets"), *(cells(change) for change in changed)])
    if tolerance_um is not None:
        verdict = "within" if found.largest_um <= tolerance_um else "beyond"
        said.append(
            f"Largest deviation {found.largest_um:.2f} µm: {verdict} the tolerance {tolerance_um:g} µm"
        )
    return said


def _spread(spread: Spread) -> list[str]:
    shares = ", ".join(f"{share} % within {value:.2f} µm" for share, value in spread.percentiles_um.items())
    return [
        f"  largest {where(spread.most)}",
        f"  least   {where(spread.least)}",
        f"  rms {spread.rms_um:.2f} µm; {shares} of the area",
    ]


def where(extreme: Extreme) -> str:
    """A deviation and its place; the place only where there is a deviation."""
    value = f"{extreme.deviation_um:+.2f} µm" if extreme.deviation_um else "0.00 µm"
    if not extreme.deviation_um:
        return value
    place = f", {extreme.place}" if extreme.place else ""
    return f"{value} at z {extreme.position_mm[2]:.3f} mm, radius {extreme.radius_mm:.3f} mm{place}"


def cells(change: Change) -> tuple[str, str, str, str, str]:
    """Key, A, B, difference, uncertainty in words."""
    difference = "" if change.difference is None else f"{change.difference:+.6g}"
    facets = f"{change.uncertainty:.2g}" if change.uncertainty else ""
    return change.key, _said(change.a), _said(change.b), difference, facets


def columns(rows: list[tuple[str, ...]]) -> list[str]:
    """Rows in aligned columns."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    return [
        "  " + "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]


def _said(value: Figure) -> str:
    if value is None:
        return "—"
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:.7g}" if isinstance(value, float) else str(value)


def to_json(found: Comparison) -> dict[str, Any]:
    """Plain values: mm and µm."""
    return {
        "surface": _spread_json(found.surface),
        "reverse": _spread_json(found.reverse),
        "largest_um": found.largest_um,
        "changes": [
            {
                "key": change.key,
                "a": change.a,
                "b": change.b,
                "difference": change.difference,
                "uncertainty": change.uncertainty,
                "changed": change.changed,
            }
            for change in found.changes
        ],
        "notes": list(found.notes),
    }


def _spread_json(spread: Spread) -> dict[str, Any]:
    return {
        **{
            name: {
                "deviation_um": end.deviation_um,
                "position_mm": list(end.position_mm),
                "radius_mm": end.radius_mm,
                "place": end.place or None,
            }
            for name, end in (("most", spread.most), ("least", spread.least))
        },
        "rms_um": spread.rms_um,
        "percentiles_um": {str(share): value for share, value in spread.percentiles_um.items()},
    }
