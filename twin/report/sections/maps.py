"""Every flank or face laid flat beside the part: small multiples, and one of them enlarged by `maps.js`."""

import json

from markupsafe import Markup

from twin.report.charts.maps import map_chart
from twin.report.colours import Legend, scale_for
from twin.report.data import ReportData
from twin.report.sections.section import Section, Tab
from twin.report.unrolled import map_deviation, unroll


def maps_section(report: ReportData) -> Section | None:
    """Draw all maps; None where nothing was measured on the mesh."""
    part = report.solid_part
    scale = scale_for(part.deviation_um) if part else None
    unrolled = unroll(part, report.inspection) if part else None
    if part is None or scale is None or unrolled is None:
        return None
    maps = map_deviation(part, unrolled)
    if maps is None:
        return None
    chart = map_chart(unrolled, maps, scale)
    what = "tooth" if report.inspection.gear else "face"
    tiles = [
        {"row": tile.row, "name": tile.name, "box": tile.box, "direction": round(tile.direction_deg, 3)}
        for tile in chart.tiles
    ]
    return Section(
        name="maps",
        tab=Tab.PART,
        title="Flanks unrolled" if report.inspection.gear else "Faces unrolled",
        values={
            "chart": chart,
            "what": what,
            "rows": [name for name, _ in unrolled.rows],
            "tiles": Markup(json.dumps(tiles)),
            "across": maps.across,
            "z": maps.z,
            "ends": unrolled.ends,
            "across_name": unrolled.across_name,
            "legend": Legend.of(part.deviation_um),
        },
    )
