"""The single figures of `inspection.json` by their keys: what can be expected of a part and compared."""

from collections.abc import Mapping
from enum import Enum
from typing import Any

from twin.inspection.sheet import FLANK_KEYS
from twin.inspection.tolerances import ITEMS

Figure = float | str | bool | None
"""None: not measured"""


class Quantity(Enum):
    """What stands under a key."""

    NUMBER = "a number"
    COUNT = "a whole number"
    FLAG = "true or false"
    KIND = "gear, polygon or none"
    VERDICT = "in, out or not_graded"
    HAND = "spur, right, left or none"
    FLATNESS_CLASS = "H, K, L or worse"

    @property
    def words(self) -> tuple[str, ...]:
        """What may stand there, where it is one of a few words."""
        return () if self in (self.NUMBER, self.COUNT, self.FLAG) else _words(self.value)


def _words(text: str) -> tuple[str, ...]:
    return tuple(text.replace(" or ", ", ").split(", "))


_FILTERED = tuple(key for key in FLANK_KEYS if key.startswith(("profile", "helix")))
COMMON: Mapping[str, Quantity] = {"kind": Quantity.KIND, "verdict": Quantity.VERDICT, "hand": Quantity.HAND}
GEAR: Mapping[str, Quantity] = {
    "number_of_teeth": Quantity.COUNT,
    **dict.fromkeys(
        (
            "normal_module",
            "helix_angle_deg",
            "lead_mm",
            "profile_shift",
            "tip_diameter_mm",
            "root_diameter_mm",
        ),
        Quantity.NUMBER,
    ),
    "span_teeth": Quantity.COUNT,
    **dict.fromkeys(
        (
            "span_mm",
            "pin_diameter_mm",
            "over_pins_mm",
            "runout_um",
            "flank_offset_um",
            "tooth_thickness_mm",
            "chordal_thickness_mm",
            "chordal_height_mm",
            "form_diameter_mm",
            "tip_form_diameter_mm",
        ),
        Quantity.NUMBER,
    ),
    "undercut": Quantity.FLAG,
    "chamfered": Quantity.FLAG,
    **{f"flanks.{side}.{key}": Quantity.NUMBER for side in ("left", "right") for key in FLANK_KEYS},
    **{f"flanks.{side}.filtered.{key}": Quantity.NUMBER for side in ("left", "right") for key in _FILTERED},
    **{f"accuracy_class.{item}": Quantity.COUNT for item in (*ITEMS, "overall")},
    **{f"accuracy_class_filtered.{item}": Quantity.COUNT for item in (*ITEMS, "overall")},
}
POLYGON: Mapping[str, Quantity] = {
    "number_of_sides": Quantity.COUNT,
    **dict.fromkeys(
        (
            "across_flats_mm",
            "across_flats_planes_mm",
            "across_flats_caliper_mm",
            "across_flats_caliper_least_mm",
            "across_corners_mm",
            "across_corners_least_mm",
            "bow_um",
            "flatness_um",
            "twist_deg_per_mm",
            "concentricity_um",
        ),
        Quantity.NUMBER,
    ),
    "flatness_class": Quantity.FLATNESS_CLASS,
}
KEYS: Mapping[str, Quantity] = {**COMMON, **GEAR, **POLYGON}
"""of the part"""
CUTTING_LOAD: Mapping[str, Quantity] = {
    **dict.fromkeys(("cutting_load.settled", "cutting_load.stalled"), Quantity.FLAG),
    **dict.fromkeys(("cutting_load.windows", "cutting_load.rounds"), Quantity.COUNT),
    **{
        f"cutting_load.{name}": Quantity.NUMBER
        for name in (
            "mean_rounds",
            "moved_um",
            "frequency_hz",
            "torque_limit",
            "mean_torque",
            "torque_line_hz",
            "torque_line",
            "k_c11",
            "m_c",
            "tool_stiffness_n_per_um",
            "work_stiffness_n_per_um",
            "removed_mm3",
            "energy_j",
            "mean_power_w",
            "largest_power_w",
            "largest_deflection_um",
            *(f"largest_{letter}" for letter in "XYZABC"),
        )
    },
}
"""of a run under cutting forces; forces by axis letter [N, N m]"""


def figure(values: Mapping[str, Any], key: str) -> Figure:
    """What `inspection.json` (`to_json`) says under a key; None where it is null or not there.

    A part that is neither gear nor polygon is of the kind "none".
    """
    value: Any = values
    for name in key.split("."):
        value = value.get(name) if isinstance(value, Mapping) else None
    return "none" if key == "kind" and value is None else value


def uncertainty(values: Mapping[str, Any], key: str) -> float:
    """How much of a figure the mesh's own facets can make, in its unit; 0 where none is told."""
    *way, name = key.split(".")
    told = figure(values, ".".join([*(step for step in way if step != "filtered"), "uncertainty"]))
    given = told.get(name) if isinstance(told, Mapping) else None
    return float(given) if isinstance(given, int | float) else 0.0
