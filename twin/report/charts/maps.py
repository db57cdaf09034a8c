"""Small multiples of all flanks or faces, unrolled, in one common scale of colours."""

from dataclasses import dataclass

import numpy as np
from markupsafe import Markup
from numpy.typing import NDArray

from twin.report.colours import Scale, palette
from twin.report.drawing import Drawing
from twin.report.images import data_url
from twin.report.png import png_indexed
from twin.report.scale import number
from twin.report.unrolled import Maps, Unrolled

WIDTH = 180.0
"""[mm]"""
MARGIN = 9.0
"""left of the maps, for the figures of z [mm]"""
MOST_COLUMNS = 24
FEWEST_COLUMNS = 6
MOST_SHOWN = 120
"""patches of one row that are shown; of more, some evenly spread"""
TALLEST = 30.0
"""of one map [mm]"""
GAP = 0.5
"""between two maps [mm]"""
HEAD, FOOT = 4.6, 4.0
"""above each row for its name, below for the numbers [mm]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tile:
    """Where one map stands in the drawing."""

    row: str
    name: str
    box: tuple[float, float, float, float]
    """left, top, width, height [mm]"""
    direction_deg: float
    """of the flank or face, seen from the axis"""


@dataclass(frozen=True, slots=True, kw_only=True)
class MapChart:
    """The drawing and its tiles."""

    svg: Markup
    tiles: tuple[Tile, ...]
    left_out: int
    """patches of a row that are not shown"""


def map_chart(unrolled: Unrolled, maps: Maps, scale: Scale) -> MapChart:
    """Draw every patch, row by row."""
    per_row = max(len(names) for _, names in unrolled.rows)
    shown = _spread(per_row)
    columns = max(min(len(shown), MOST_COLUMNS), FEWEST_COLUMNS)
    pitch = (WIDTH - MARGIN) / columns
    ratio = (maps.z[1] - maps.z[0]) / ((maps.across[1] - maps.across[0]) or 1.0)
    width = pitch - GAP
    height = min(TALLEST, max(4.0, width * ratio))
    lines = [shown[k : k + columns] for k in range(0, len(shown), columns)]
    total = len(unrolled.rows) * len(lines) * (HEAD + height + FOOT) + 1.0
    drawing = Drawing("maps", WIDTH, total)
    colours = np.concatenate([palette(), np.full((256, 1), 255, np.uint8)], axis=1)
    colours[0, 3] = 0
    tiles: list[Tile] = []
    top = 0.0
    for line in lines:
        first = 0
        for row, names in unrolled.rows:
            drawing.text(MARGIN, top + 3.0, row, f"title {row.split()[0].lower()}")
            top += HEAD
            patches = [first + k for k in line]
            picture = data_url(png_indexed(_strip(maps, patches, scale, GAP / pitch), colours, level=4))
            drawing.image(MARGIN, top, pitch * len(line), height, picture)
            for place, k in enumerate(line):
                left = MARGIN + place * pitch
                drawing.rectangle(left, top, width, height, "frame")
                drawing.text(left + width / 2, top + height + 2.8, names[k], "small", anchor="middle")
                tiles.append(
                    Tile(
                        row=row,
                        name=names[k],
                        box=(left, top, width, height),
                        direction_deg=unrolled.direction_deg[first + k],
                    )
                )
            for value, y in ((maps.z[1], top + 2.0), (maps.z[0], top + height)):
                drawing.text(MARGIN - 0.8, y, number(value, 1), "small", anchor="end")
            first += len(names)
            top += height + FOOT
    svg = drawing.svg("Deviation of every flank or face, unrolled; numbers below each")
    return MapChart(svg=svg, tiles=tuple(tiles), left_out=per_row - len(shown))


def _spread(count: int) -> list[int]:
    """All of `count`, or MOST_SHOWN of them."""
    if count <= MOST_SHOWN:
        return list(range(count))
    return sorted({round(k) for k in np.linspace(0, count - 1, MOST_SHOWN).tolist()})


def _strip(maps: Maps, patches: list[int], scale: Scale, gap: float) -> NDArray[np.uint8]:
    """(height, width) colour indices of some maps side by side, each followed by its share of a gap."""
    _, height, width = maps.deviation_um.shape
    pixels = round(width * gap / (1 - gap))
    index = np.zeros((height, len(patches), width + pixels), np.uint8)
    index[:, :, :width] = scale.index(maps.deviation_um[patches]).transpose(1, 0, 2)
    return index.reshape(height, -1)
