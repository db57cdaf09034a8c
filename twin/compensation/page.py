"""`compensation.html`: how the part was clamped, what was done about it, and both gears side by side."""

import math
from pathlib import Path

from jinja2 import ChoiceLoader, Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

import twin.report.page as report_page
from twin.compensation.charts import removal_chart, touch_chart
from twin.compensation.correction import Way
from twin.compensation.text import (
    figures,
    figures_of_uncertainty,
    fits,
    phase_deg,
    remaining_slope_um,
    rounding_um,
    table,
    theory,
)
from twin.compensation.walk import Compensation, Stage
from twin.report import tables
from twin.report.charts.pitch import pitch_chart
from twin.report.charts.traces import helix_chart, profile_chart
from twin.report.page import lowered
from twin.report.scale import number

STYLES = (*report_page.STYLES, report_page.PRINT)
OWN = Path(__file__).parent / "assets" / "compensation.css"


def render(found: Compensation) -> str:
    """The page as HTML."""
    measured, law = found.measurement, found.corrections
    stock = found.job.work.gear
    before, after = found.before.removal, found.after.removal
    return _ENVIRONMENT.get_template("compensation.html").render(
        title=found.job.name,
        css=Markup(
            "\n".join(
                path.read_text(encoding="utf-8") for path in (*(report_page.ASSETS / s for s in STYLES), OWN)
            )
        ),
        sentence=_sentence(found),
        way=found.way.value,
        good=found.after.outcome.exit_code == 0,
        fits=[
            (
                name,
                f"{circle.x:+.5f}",
                f"{circle.y:+.5f}",
                f"{circle.eccentricity:.5f}",
                f"{phase_deg(circle):.3f}",
            )
            for name, circle in fits(found)
        ],
        touches=len(measured.radius_mm),
        round_um=number(measured.centre.out_of_round_mm * 1e3, 2),
        uncertainty_um=number(measured.centre.uncertainty_mm * 1e3, 2),
        touch_chart=touch_chart(measured),
        rows=[(name, number(a, 2), number(b, 2)) for name, a, b in table(found)],
        theory={key: number(value, 2) for key, value in theory(found).items()},
        rest={key: number(value, 2) for key, value in figures_of_uncertainty(found).items()},
        words=number(rounding_um(found), 2),
        removal=None
        if stock is None or before is None or after is None
        else removal_chart(before, after, stock.stock_per_flank_mm * 1e3),
        stock_um=None if stock is None else number(stock.stock_per_flank_mm * 1e3, 0),
        slope=None
        if found.way is not Way.TURNED
        else {
            "mrad": number(float(abs(law.beta).max()) * 1e3, 3),
            "um": number(remaining_slope_um(found), 2),
        },
        sheets=[_sheet(name, stage) for name, stage in (("before", found.before), ("after", found.after))],
        gaps=[
            (
                k + 1,
                f"{psi:.3f}",
                f"{math.degrees(c):+.4f}",
                f"{x * 1e3:+.2f}",
                f"{y * 1e3:+.2f}",
            )
            for k, (psi, c, x, y) in enumerate(
                zip(found.gaps_deg, law.c.tolist(), law.x.tolist(), law.y.tolist(), strict=True)
            )
        ],
    )


def _sentence(found: Compensation) -> str:
    circle = found.measurement.centre.geometric
    a, b = figures(found.before), figures(found.after)

    def worst(values: dict[str, float | None]) -> str:
        both = (values["cumulative_pitch_left"], values["cumulative_pitch_right"])
        return number(max((v for v in both if v is not None), default=None), 1, "µm")

    return (
        f"The part is clamped {circle.eccentricity * 1e3:.1f} µm off the spindle's axis, towards "
        f"{phase_deg(circle):.1f}°. Made as it stands its cumulative pitch is off by {worst(a)}, "
        f"compensated by {worst(b)}."
    )


def _sheet(name: str, stage: Stage) -> dict[str, object]:
    inspection = stage.outcome.inspection
    gear = inspection.gear
    charts = () if gear is None else (profile_chart(gear), helix_chart(gear), pitch_chart(gear))
    return {
        "name": name,
        "verdict": inspection.verdict.value,
        "findings": inspection.findings,
        "rows": () if gear is None else tables.graded(gear),
        "charts": [_own(chart, name) for chart in charts if chart],
    }


def _own(svg: Markup, prefix: str) -> Markup:
    """A picture whose ids are its own on a page that has it twice."""
    return Markup(str(svg).replace('id="', f'id="{prefix}-').replace("url(#", f"url(#{prefix}-"))


_ENVIRONMENT = Environment(
    loader=ChoiceLoader([PackageLoader(name, "assets") for name in ("twin.compensation", "twin.report")]),
    autoescape=True,
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)
_ENVIRONMENT.filters["lowered"] = lowered
