"""A point of the stock and a cutting edge, at the instant when they meet and near it."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Meeting:
    """Where and how pairs of point and pass meet; arrays over pairs."""

    depth: Floats
    """(m,) [mm] positive = removed by this pass"""
    gradient: Floats
    """(m, 3) of the depth in the part frame; (0, 3) unless asked for"""
    s: Floats
    """(m,) axial position against the edge's outline [mm]"""
    rho: Floats
    """(m,) distance from the tool axis [mm]"""
    instant: Floats
    """(m,) sample (fractional) of the motion at which they meet"""
    slack: Floats = field(default_factory=lambda: np.zeros(0))
    """(m,) [mm] to add to what rises above the tangent; of disc cutters, where the gradient was asked for"""

    def of(self, rows: Ints | NDArray[np.bool_]) -> "Meeting":
        """Some of the pairs."""
        return Meeting(*(v[rows] if len(v := getattr(self, name)) else v for name in self.__slots__))


@dataclass(frozen=True, slots=True)
class State:
    """Points seen from the tool at given instants."""

    cos: Floats
    """of the work angle"""
    sin: Floats
    side: Floats
    """(2, m) position across the tool axis, along basis 0 and 1"""
    rho: Floats
    s: Floats
    rho_rate: Floats
    """per sample, like the following"""
    s_rate: Floats
    lag: Floats
    """[rad] edge angle minus point angle"""
    lag_rate: Floats
    tool_angle: Floats
    tool_rate: Floats
    lean: Floats
    """(2, m) of the tool's own axis (`CutterMotion.lean`); (2, 0) where it has none"""

    def put(self, rows: Ints, part: "State") -> None:
        """Replace some points."""
        for name in self.__slots__:
            values = getattr(self, name)
            if values.size:
                values[..., rows] = getattr(part, name)
