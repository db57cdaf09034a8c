"""The polygon-turning head: inserts with straight edges parallel to the tool axis (geometry.md 3)."""

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from msgspec import Meta

from twin.cutters.cutter import Cutter
from twin.cutters.profile import ToothProfile, tooth_profile
from twin.cutters.rack import Chain
from twin.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class PolygonHead:
    """A cutter head whose axis is parallel to the work's."""

    inserts: Annotated[int, Meta(ge=1, le=100)]
    """P"""
    tip_radius_mm: Annotated[float, Meta(gt=0)]
    """R"""
    edge_width_mm: Annotated[float, Meta(gt=0)] = 2.0
    corner_radius_mm: Annotated[float, Meta(ge=0)] = 0.0
    profile: Chain | None = None
    """the edge instead of a straight one: (half-width, depth below the tip[, radius of the arc to the next])
    [mm] from the tip inwards, then straight on"""

    def __post_init__(self) -> None:
        for name, preset in (("edge_width_mm", 2.0), ("corner_radius_mm", 0.0)):
            if self.profile is not None and getattr(self, name) != preset:
                raise InputError(f"{name} stands beside profile, which says it all", remedy=f"without {name}")
        if 2.0 * self.corner_radius_mm > self.edge_width_mm:
            raise InputError(
                f"corner_radius_mm {self.corner_radius_mm:g} is more than half of edge_width_mm "
                f"{self.edge_width_mm:g}",
                remedy=f"valid: 0 to {self.edge_width_mm / 2:g}",
            )
        self.edge()

    @property
    def breadth_mm(self) -> float:
        """Of the edge where it is widest."""
        return self.edge_width_mm if self.profile is None else 2.0 * self.edge().half_width

    def edge(self) -> ToothProfile:
        """Outline of an insert."""
        half, corner = self.edge_width_mm / 2.0, self.corner_radius_mm
        chain = self.profile
        if chain is None:
            flat = ((half, 0.0),) if corner == 0 else ((half - corner, 0.0, corner), (half, corner))
            chain = (*flat, (half, 2.0 * corner + half))
        return tooth_profile(chain, tip=self.tip_radius_mm, land=False)

    def cutter(self) -> Cutter:
        """The head with insert 0 at tool angle 0."""
        return Cutter(
            gash_angle=2.0 * math.pi * np.arange(self.inserts) / self.inserts,
            gash_shift=np.zeros(self.inserts),
            profile=self.edge(),
            half_length=math.inf,
            shift=0.0,
            swivel=0.0,
            twist=0.0,
        )
