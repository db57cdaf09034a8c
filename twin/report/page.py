"""`report.html`: one file that opens anywhere, without network, and prints."""

import base64
import json
import re
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from twin.errors import InputError, Place
from twin.report import tables, words
from twin.report.colours import gradient, palette, scale_for
from twin.report.data import Part, ReportData, Severity
from twin.report.labels import Label, labels
from twin.report.motion import motion_chart
from twin.report.payload import encode, thinned
from twin.report.pictures import END, ISOMETRIC, place, render_part
from twin.report.pitch import pitch_chart
from twin.report.scale import number
from twin.report.section import section_chart
from twin.report.traces import MOST_TRACES, helix_chart, profile_chart

PICTURE_SIZE = (680, 540)
"""[pixels]"""
STILLS = {"Isometric, front face on top": ISOMETRIC, "Front face, C0 to the right": END}
MOST_TRIANGLES = 600_000
"""that are embedded as they are; a larger mesh is thinned out for the view"""
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ufffe\uffff]")
_ENVIRONMENT = Environment(
    loader=PackageLoader("twin.report", "assets"),
    autoescape=True,
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)


def write_report(path: Path, report: ReportData) -> None:
    """Write the page; InputError where the file cannot be written."""
    try:
        path.write_text(render(report), encoding="utf-8", errors="replace")
    except OSError as error:
        raise InputError(f"cannot write the report: {error.strerror}", place=Place(file=str(path))) from error


def render(report: ReportData) -> str:
    """Return the page as HTML."""
    part = report.part if report.part is not None and len(report.part.faces) else None
    numbers = labels(report.inspection)
    # numpy leaves the interpreter free most of the time, so the pictures are drawn beside the charts.
    with ThreadPoolExecutor(1) as beside:
        stills = beside.submit(_stills, part, numbers) if part else None
        charts = _charts(report)
        viewer = _viewer(part, numbers) if part else None
        html = _ENVIRONMENT.get_template("report.html").render(
            report=report,
            headline=words.headline(report),
            key_figures=tables.key_figures(report.inspection),
            comparison=tables.comparison(report.inspection),
            graded=tables.graded(report.inspection.gear) if report.inspection.gear else (),
            class_reached=tables.class_reached(report.inspection.gear, "overall")
            if report.inspection.gear
            else "",
            class_allowed=tables.class_allowed(report.inspection),
            missing=words.missing(report.inspection),
            charts=charts,
            most_traces=MOST_TRACES,
            viewer=viewer,
            stills=stills.result() if stills else (),
            pictures=[(picture.caption, _data_url(picture.png)) for picture in report.pictures],
            programs=[
                (program.name, tables.listing(program, report.messages)) for program in report.programs
            ],
            alarm=Severity.ALARM,
            number=number,
            css=_asset("report.css"),
            script=_asset("viewer.js"),
        )
    return _CONTROL.sub("\ufffd", html)


def _charts(report: ReportData) -> dict[str, Markup]:
    """SVG by name, of what there is to draw."""
    gear, polygon = report.inspection.gear, report.inspection.polygon
    drawn: dict[str, str | None] = {}
    if gear:
        drawn |= {"profile": profile_chart(gear), "helix": helix_chart(gear), "pitch": pitch_chart(gear)}
    if polygon:
        drawn["section"] = section_chart(polygon)
    if report.recording:
        drawn["motion"] = motion_chart(report.recording, report.rotary_axes)
    return {name: Markup(svg) for name, svg in drawn.items() if svg is not None}


def _stills(part: Part, numbers: tuple[Label, ...]) -> tuple[dict[str, Any], ...]:
    """Captions, data URLs and sizes of the still pictures, and where numbers stand on them."""
    pngs = render_part(part.vertices, part.faces, PICTURE_SIZE, STILLS.values())
    anchors = np.array([label.position_mm for label in numbers]).reshape(-1, 3)
    places = place(part.vertices, PICTURE_SIZE, END, anchors)
    return tuple(
        {
            "caption": caption,
            "url": _data_url(png),
            "size": PICTURE_SIZE,
            "numbers": [(label.text, *at) for label, at in zip(numbers, places, strict=True)]
            if view is END
            else (),
        }
        for (caption, view), png in zip(STILLS.items(), pngs, strict=True)
    )


def _viewer(part: Part, numbers: tuple[Label, ...]) -> dict[str, Any]:
    """What the template needs to set up the view that turns."""
    shown = thinned(part, MOST_TRIANGLES)
    scale = scale_for(part.deviation_um)
    index = scale.index(shown.deviation_um) if scale else np.zeros(len(shown.vertices), np.uint8)
    payload = encode(shown.vertices, shown.faces, index)
    colours = palette()
    header = payload.header() | {
        "limitUm": scale.limit_um if scale else None,
        "palette": base64.b64encode(colours.tobytes()).decode("ascii"),
        "labels": [(label.text, *label.position_mm) for label in numbers],
    }
    return {
        "header": Markup(json.dumps(header)),
        "data": Markup(payload.data),
        "scale": scale,
        "gradient": gradient(colours),
        "triangles": len(shown.faces),
        "all_triangles": len(part.faces),
    }


def _data_url(png: bytes) -> str:
    return "data:image/png;base64," + base64.b64encode(png).decode("ascii")


def _asset(name: str) -> Markup:
    return Markup(Path(__file__).parent.joinpath("assets", name).read_text(encoding="utf-8"))
