"""What changed from one inspection to another, figure by figure."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from twin.inspection.keys import COMMON, GEAR, POLYGON, Figure, figure, uncertainty

RESOLUTION = {"_mm": 1e-4, "_um": 0.01, "_deg": 1e-4}
"""by the unit a key ends in: what is told of a figure whose uncertainty nobody knows"""
OTHERWISE = 1e-4


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """One figure of both parts."""

    key: str
    a: Figure
    b: Figure
    difference: float | None
    """a − b; None where one of them is no number"""
    uncertainty: float
    """how much of the difference the facets of both meshes can make, at least the resolution of the figure"""

    @property
    def changed(self) -> bool:
        """Whether it differs by more than that."""
        if self.difference is None:
            return self.a != self.b
        return abs(self.difference) > self.uncertainty


def changes(a: Mapping[str, Any], b: Mapping[str, Any]) -> tuple[Change, ...]:
    """All figures that one of the parts has; both as in inspection.json (`to_json`)."""
    found = (_change(key, a, b) for key in (*COMMON, *GEAR, *POLYGON))
    return tuple(one for one in found if one.a is not None or one.b is not None)


def _change(key: str, a: Mapping[str, Any], b: Mapping[str, Any]) -> Change:
    one, other = figure(a, key), figure(b, key)
    numbers = all(isinstance(v, int | float) and not isinstance(v, bool) for v in (one, other))
    measured = isinstance(one, float) or isinstance(other, float)
    finest = next((value for unit, value in RESOLUTION.items() if key.endswith(unit)), OTHERWISE)
    return Change(
        key=key,
        a=one,
        b=other,
        difference=float(one) - float(other) if numbers and one is not None and other is not None else None,
        uncertainty=max(uncertainty(a, key) + uncertainty(b, key), finest) if measured else 0.0,
    )
