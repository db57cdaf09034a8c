"""The walk in words and in JSON values."""

import math

import numpy as np

from twin.compensation.correction import Way
from twin.compensation.walk import Compensation, Stage
from twin.probing.circle import Circle

HALF_WORD_UM = 0.5
"""half of 0.001 mm, or of 0.001° in thousandths"""
SHOWN = 3
"""gaps that the terminal shows"""


def lines(found: Compensation) -> list[str]:
    """For the terminal."""
    measured, centre = found.measurement, found.measurement.centre
    said = [
        f"probed: {len(measured.radius_mm)} touches in {measured.time_s:.1f} s, band as touched "
        f"Ø {2 * centre.geometric.radius:.4f} mm, out of round {centre.out_of_round_mm * 1e3:.2f} µm",
        *(
            f"  {name:<22} e {circle.eccentricity:.5f} mm, phi {phase_deg(circle):.3f}°"
            for name, circle in fits(found)
        ),
        f"  uncertainty of the centre, 95 %: {centre.uncertainty_mm * 1e3:.2f} µm; as F_p "
        f"{figures_of_uncertainty(found)['cumulative_pitch_um']:.2f} µm",
        f"  words of 0.001 mm and 0.001°: up to {rounding_um(found):.2f} µm of F_p",
    ]
    said.append(f"compensated by {found.way.value}")
    law = found.corrections
    for k in range(min(SHOWN, len(found.gaps_deg))):
        said.append(
            f"  gap {k + 1:>2} at {found.gaps_deg[k]:8.3f}°: C {math.degrees(law.c[k]):+9.4f}°, "
            f"X {law.x[k] * 1e3:+7.2f} µm, Y {law.y[k] * 1e3:+7.2f} µm"
        )
    if found.way is Way.TURNED:
        said.append(
            f"  no Y axis: the gaps stay off by up to {np.abs(law.beta).max() * 1e3:.3f} mrad, "
            f"{remaining_slope_um(found):.2f} µm over a flank's height, opposite on both flanks"
        )
    said.append(f"  {'':<34}{'before':>10}{'after':>10}   µm")
    said += [f"  {name:<34}{_um(a):>10}{_um(b):>10}" for name, a, b in table(found)]
    return said


def figures_of_uncertainty(found: Compensation) -> dict[str, float]:
    """What the uncertainty of the centre leaves of F_p and F_r [µm]: as an eccentricity of that size."""
    rest = 2e3 * found.measurement.centre.uncertainty_mm
    return {"cumulative_pitch_um": rest / _cosine(found), "runout_um": rest}


def rounding_um(found: Compensation) -> float:
    """What words of 0.001 mm and 0.001° may make of F_p at the worst [µm]: X in diameter, C and, where the
    machine has it, Y by half a word each, and the other way at another gap."""
    radius = found.gear.measuring_diameter / 2.0
    tangent = math.sqrt(1.0 / _cosine(found) ** 2 - 1.0)
    across = HALF_WORD_UM if found.way is Way.ACROSS else 0.0
    return 2.0 * (HALF_WORD_UM / 2.0 * tangent + across + math.radians(HALF_WORD_UM) * radius)


def theory(found: Compensation) -> dict[str, float]:
    """F_p and F_r of a gear that nobody compensates, from the measured e [µm]."""
    e = 2e3 * found.measurement.centre.geometric.eccentricity
    return {"cumulative_pitch_um": e / _cosine(found), "runout_um": e}


def _cosine(found: Compensation) -> float:
    """Of the pressure angle on the circle where pitch is measured; cos α_t without profile shift."""
    return found.gear.base_diameter / found.gear.measuring_diameter


def remaining_slope_um(found: Compensation) -> float:
    """How far the ends of a flank stand off each other for the slope that stays [µm]."""
    height = (found.gear.tip_diameter - found.gear.form_diameter) / 2.0
    return float(np.abs(found.corrections.beta).max()) * height * 1e3


def table(found: Compensation) -> list[tuple[str, float | None, float | None]]:
    """What is compared: name, before, after [µm]."""
    a, b = figures(found.before), figures(found.after)
    return [(NAMES[key], a[key], b[key]) for key in NAMES if a[key] is not None or b[key] is not None]


NAMES = {
    "cumulative_pitch_left": "cumulative pitch F_p, left",
    "cumulative_pitch_right": "cumulative pitch F_p, right",
    "runout": "runout F_r",
    "single_pitch_left": "single pitch f_p, left",
    "single_pitch_right": "single pitch f_p, right",
    "removal_left_least": "least stock removed, left",
    "removal_left_most": "most stock removed, left",
    "removal_right_least": "least stock removed, right",
    "removal_right_most": "most stock removed, right",
}


def figures(stage: Stage) -> dict[str, float | None]:
    """The figures of one gear [µm]; None where they were not measured."""
    gear, taken = stage.outcome.inspection.gear, stage.removal
    values: dict[str, float | None] = dict.fromkeys(NAMES)
    if gear is not None:
        values["cumulative_pitch_left"] = gear.left.cumulative_pitch_um
        values["cumulative_pitch_right"] = gear.right.cumulative_pitch_um
        values["single_pitch_left"] = gear.left.single_pitch_um
        values["single_pitch_right"] = gear.right.single_pitch_um
        values["runout"] = gear.runout_um
    if taken is not None:
        for side in ("left", "right"):
            least, most = taken.extremes(side)
            values[f"removal_{side}_least"] = least * 1e3
            values[f"removal_{side}_most"] = most * 1e3
    return values


def as_json(found: Compensation) -> dict[str, object]:
    """For programs: mm, degrees, µm where the name says so."""
    measured, centre, law = found.measurement, found.measurement.centre, found.corrections
    return {
        "job": found.job.name,
        "way": found.way.value,
        "touches": {"radius_mm": measured.radius_mm.tolist(), "c_deg": measured.angle_deg.tolist()},
        "fits": {
            name: {
                "x_mm": circle.x,
                "y_mm": circle.y,
                "radius_mm": circle.radius,
                "e_mm": circle.eccentricity,
                "phi_deg": phase_deg(circle),
            }
            for name, circle in fits(found)
        },
        "out_of_round_mm": centre.out_of_round_mm,
        "uncertainty_mm": centre.uncertainty_mm,
        "covariance_mm2": centre.covariance.tolist(),
        "gaps": [
            {
                "psi_deg": psi,
                "c_deg": math.degrees(c),
                "x_mm": x,
                "y_mm": y,
                "slope_mrad": beta * 1e3 if found.way is Way.TURNED else 0.0,
            }
            for psi, c, x, y, beta in zip(
                found.gaps_deg,
                law.c.tolist(),
                law.x.tolist(),
                law.y.tolist(),
                law.beta.tolist(),
                strict=True,
            )
        ],
        "theory_um": theory(found),
        "left_by_uncertainty_um": figures_of_uncertainty(found),
        "left_by_words_um": rounding_um(found),
        "before_um": figures(found.before),
        "after_um": figures(found.after),
    }


def fits(found: Compensation) -> list[tuple[str, Circle]]:
    """The circles that were fitted, by name."""
    centre = found.measurement.centre
    fits = [("patent", centre.patent), ("geometric", centre.geometric)]
    return fits if found.measurement.macro is None else [*fits, ("cycle (Macro B)", found.measurement.macro)]


def phase_deg(circle: Circle) -> float:
    """φ from 0 to 360 [deg]."""
    return math.degrees(circle.phase) % 360.0


def _um(value: float | None) -> str:
    return "—" if value is None else f"{value:.2f}"
