"""What the mesher asks of a tool's depth field, and which field a tool has."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from twin.cutters.cutter import Cutter
from twin.cutting.field import DepthField
from twin.cutting.meeting import Meeting
from twin.cutting.motion import CutterMotion
from twin.cutting.wheel_field import WheelField

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class Counted(Protocol):
    """Passes, or what stands for them."""

    @property
    def count(self) -> int:
        """Their number."""
        ...


class Field(Protocol):
    """The depth field of one tool: `DepthField` of edges, `WheelField` of a body of revolution."""

    bites: int
    """of a pass"""
    tooth: Ints
    """(bites,) number of each bite's tooth along the edge"""

    @property
    def passes(self) -> Counted:
        """Of the tool."""
        ...

    @property
    def count(self) -> int:
        """Number of bites."""
        ...

    def evaluate(self, points: Floats, index: Ints, *, gradient: bool = False) -> Meeting:
        """Depth of points (m, 3) in passes (m,)."""
        ...

    def evaluate_bite(self, points: Floats, bite: Ints, *, gradient: bool = False) -> Meeting:
        """Depth of points (m, 3) in bites (m,)."""
        ...

    def bound(self, meeting: Meeting, bite: Ints, radius: Floats) -> tuple[Floats, Floats]:
        """How much a bite's depth can change, and rise above its tangent, within `radius` (m,)."""
        ...

    def floors(self, points: Floats, corners: Floats, bite: Ints, radius: Floats) -> Floats:
        """Lower bounds (c, m) of bites' depths in the convex hulls of `corners` (m, c, 3)."""
        ...

    def near(self, point: Floats, radius: float, among: Ints | None = None) -> Ints:
        """Passes, of all or `among` some (m,), that may cut within `radius` of a point (3,)."""
        ...

    def bites_near(self, points: Floats, index: Ints, radius: Floats) -> tuple[Ints, Ints]:
        """Rows and bites of the passes `index` (m,) that may cut within `radius` (m,) of points (m, 3)."""
        ...


def tool_field(
    cutter: Cutter, motion: CutterMotion, stock_radius: float, stock_z: tuple[float, float]
) -> Field:
    """The field of a tool for stock within `stock_radius` between these z [mm], in the part frame."""
    kind = WheelField if cutter.revolved else DepthField
    return kind(cutter, motion, stock_radius, stock_z)
