"""Units of length: what a file may declare, what a user may name, and what a wrong one looks like."""

from collections.abc import Mapping
from dataclasses import dataclass

MILLIMETRES: Mapping[str, float] = {
    "mm": 1.0,
    "cm": 10.0,
    "m": 1000.0,
    "um": 0.001,
    "inch": 25.4,
    "ft": 304.8,
}
"""unit, as a user names it -> its length [mm]"""
DECLARED: Mapping[str, str] = {
    "micron": "um",
    "millimeter": "mm",
    "centimeter": "cm",
    "meter": "m",
    "inch": "inch",
    "foot": "ft",
}
"""unit, as a 3MF file declares it -> as a user names it"""
NEAR = 0.05
"""how far from the ratio of two units a size may be to be taken for it"""


@dataclass(frozen=True, slots=True, kw_only=True)
class UnitMistake:
    """A size that is off by the ratio of a unit to the millimetre."""

    factor: float
    """the size found over the size wanted"""
    explanation: str
    """what it looks like, and the way out"""


MISTAKES = (
    UnitMistake(factor=1 / 25.4, explanation="the mesh seems to be in inches: try --units inch"),
    UnitMistake(factor=1 / 1000, explanation="the mesh seems to be in metres: try --units m"),
    UnitMistake(factor=1 / 10, explanation="the mesh seems to be in centimetres: try --units cm"),
    UnitMistake(factor=25.4, explanation="millimetres seem to have been taken for inches: try --units mm"),
    UnitMistake(
        factor=1000,
        explanation="the mesh seems to be in micrometres, or millimetres to have been taken for metres: "
        "try --units um or --units mm",
    ),
    UnitMistake(factor=10, explanation="millimetres seem to have been taken for centimetres: try --units mm"),
)


def wrong_unit(found_mm: float, wanted_mm: float) -> UnitMistake | None:
    """Return the mistake that a size found [mm] against one wanted [mm] looks like, if any."""
    ratio = found_mm / wanted_mm
    return next((m for m in MISTAKES if abs(ratio / m.factor - 1) < NEAR), None)
