"""The first thing on the page: the verdict in words, the key figures, two pictures of the part."""

import numpy as np

from twin.report import tables, words
from twin.report.colours import Legend, palette, scale_for
from twin.report.data import Part, ReportData
from twin.report.images import data_url
from twin.report.labels import Label, labels
from twin.report.pictures import END, ISOMETRIC, Tint, place, render_part
from twin.report.sections.section import Section, Tab

PICTURE_SIZE = (560, 446)
"""[pixels]"""


def verdict_section(report: ReportData) -> Section:
    """Say what came out."""
    part = report.solid_part
    return Section(
        name="verdict",
        tab=Tab.OVERVIEW,
        title="",
        values={
            "title": report.title,
            "headline": words.headline(report),
            "key_figures": tables.key_figures(report.inspection),
            "stills": _stills(part, labels(report.inspection)) if part else (),
            "legend": Legend.of(part.deviation_um) if part else None,
            "pictures": [(picture.caption, data_url(picture.png)) for picture in report.pictures],
        },
    )


def _stills(part: Part, numbers: tuple[Label, ...]) -> tuple[dict[str, object], ...]:
    """The part coloured by its deviation where it has one, and its front face with numbers."""
    scale = scale_for(part.deviation_um)
    tint = Tint(index=scale.index(part.deviation_um), palette=palette()) if scale else None
    views = ((ISOMETRIC, tint), (END, None))
    coloured, front = render_part(part.vertices, part.faces, PICTURE_SIZE, views)
    anchors = np.array([label.position_mm for label in numbers]).reshape(-1, 3)
    return tuple(
        {
            "caption": caption,
            "url": data_url(png),
            "size": PICTURE_SIZE,
            "coloured": view is ISOMETRIC and tint is not None,
            "numbers": [
                (label.text, *at)
                for label, at in zip(numbers, place(part.vertices, PICTURE_SIZE, view, anchors), strict=True)
            ],
        }
        for caption, view, png in (
            ("Deviation from nominal" if tint else "Isometric, front face on top", ISOMETRIC, coloured),
            ("Front face, C0 to the right", END, front),
        )
    )
