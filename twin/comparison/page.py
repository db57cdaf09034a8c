"""The comparison as one page that opens anywhere, without network, and prints."""

from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from twin.comparison.compare import Comparison, Spread
from twin.comparison.words import cells, where
from twin.errors import InputError, Place
from twin.inspection.solid import Solid
from twin.report.colours import Scale, gradient, palette, scale_for
from twin.report.images import data_url
from twin.report.page import ASSETS
from twin.report.pictures import END, ISOMETRIC, Tint, render_part

SIZE = (680, 540)
"""[pixels] of a picture"""
VIEWS = {"Isometric, front face on top": ISOMETRIC, "Front face, C0 to the right": END}


def write_comparison(path: Path, found: Comparison, solid: Solid, names: tuple[str, str]) -> None:
    """Write the page of part A, `solid`, against B; InputError where the file cannot be written."""
    try:
        path.write_text(render(found, solid, names), encoding="utf-8", errors="replace")
    except OSError as error:
        reason = error.strerror or "cannot be written"
        raise InputError(reason, place=Place(file=str(path)), remedy="another --report") from error


def render(found: Comparison, solid: Solid, names: tuple[str, str]) -> str:
    """Return the page as HTML."""
    scale = scale_for(found.deviation_um) or Scale(limit_um=1.0, beyond=0.0)
    colours = palette()
    tint = Tint(index=scale.index(found.deviation_um), palette=colours)
    views = [(view, tint) for view in VIEWS.values()]
    pictures = render_part(solid.vertices, solid.faces, SIZE, views)
    ordered = sorted(found.changes, key=lambda change: not change.changed)
    changed = [change.changed for change in ordered]
    return _ENVIRONMENT.get_template("comparison.html").render(
        a=names[0],
        b=names[1],
        css=Markup((ASSETS / "base.css").read_text(encoding="utf-8")),
        gradient=gradient(colours),
        limit=f"{scale.limit_um:g}",
        notes=found.notes,
        stills=[(caption, data_url(png)) for caption, png in zip(VIEWS, pictures, strict=True)],
        size=SIZE,
        shares=list(found.surface.percentiles_um),
        spreads=[_row("A from B", found.surface), _row("B from A", found.reverse)],
        changed=sum(changed),
        rows=list(zip(changed, (cells(change) for change in ordered), strict=True)),
    )


def _row(name: str, spread: Spread) -> list[str]:
    values = (spread.rms_um, *spread.percentiles_um.values())
    return [name, where(spread.most), where(spread.least), *(f"{value:.2f}" for value in values)]


_ENVIRONMENT = Environment(
    loader=PackageLoader("twin.comparison", "assets"),
    autoescape=True,
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)
