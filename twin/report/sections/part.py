"""The part in three dimensions, coloured by its deviation: what `part.js` turns."""

import base64
import json

import numpy as np
from markupsafe import Markup
from numpy.typing import NDArray

from twin.report.blocks import lines_at
from twin.report.colours import Legend, palette, scale_for
from twin.report.data import Part, ReportData
from twin.report.labels import labels
from twin.report.payload import encode, thinned
from twin.report.sections.section import Section, Tab

MOST_TRIANGLES = 600_000
"""that are embedded as they are; a larger mesh is thinned out for the view"""
MOST_BLOCKS = 1 << 16
"""that can be told apart on the part"""


def part_section(report: ReportData) -> Section:
    """Embed the part, or say that there is none."""
    part = report.solid_part
    if part is None:
        return Section(name="part", tab=Tab.PART, title="The part", values={"viewer": None})
    shown = thinned(part, MOST_TRIANGLES)
    scale = scale_for(part.deviation_um)
    index = scale.index(shown.deviation_um) if scale else np.zeros(len(shown.vertices), np.uint8)
    payload = encode(shown.vertices, shown.faces, index, _blocks(report, shown))
    header = payload.header() | {
        "limitUm": scale.limit_um if scale else None,
        "palette": base64.b64encode(palette().tobytes()).decode("ascii"),
        "labels": [(label.text, *label.position_mm) for label in labels(report.inspection)],
    }
    viewer = {
        "header": Markup(json.dumps(header)),
        "data": Markup(payload.data),
        "triangles": len(shown.faces),
        "all_triangles": len(part.faces),
    }
    title = "The part, coloured by its deviation from nominal" if scale else "The part"
    return Section(
        name="part",
        tab=Tab.PART,
        title=title,
        values={"viewer": viewer, "legend": Legend.of(part.deviation_um)},
    )


def _blocks(report: ReportData, part: Part) -> NDArray[np.integer] | None:
    """(m,) for `encode`: one more than the number of the line that cut each face; None where nobody knows."""
    if report.recording is None or not len(part.face_time_s):
        return None
    number = lines_at(report.recording, part.face_time_s) + 1
    return np.where(number < MOST_BLOCKS, number, 0)
