"""The twice smooth cubic through points (de Boor 1978, ch. IV; not-a-knot ends).

scipy has it as well, but is half a second in loading.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Spline:
    """A curve through points."""

    at: Floats
    """(n,) its parameter at the points, ascending; at least four"""
    points: Floats
    """(n, d)"""
    slope: Floats
    """(n, d) its first derivative there"""

    @classmethod
    def through(cls, at: Floats, points: Floats) -> "Spline":
        """The curve through points (n, d) at parameters (n,)."""
        step = np.diff(at)
        rate = np.diff(points, axis=0) / step[:, None]
        before, after = step[:-1], step[1:]
        matrix = np.diag(np.concatenate([[after[0]], 2.0 * (before + after), [before[-1]]]))
        matrix += np.diag(np.concatenate([[before[0] + after[0]], before]), 1)
        matrix += np.diag(np.concatenate([after, [before[-1] + after[-1]]]), -1)
        right = np.empty_like(points)
        right[1:-1] = 3.0 * (after[:, None] * rate[:-1] + before[:, None] * rate[1:])
        for row, near, far, first, second in (
            (0, before[0], after[0], rate[0], rate[1]),
            (-1, after[-1], before[-1], rate[-1], rate[-2]),
        ):
            both = near + far
            right[row] = ((near + 2.0 * both) * far * first + near * near * second) / both
        return cls(at, points, np.asarray(np.linalg.solve(matrix, right), dtype=np.float64))

    def __call__(self, where: Floats | float, derivative: int = 0) -> Floats:
        """The curve, or its first or second derivative, at parameters (...): (..., d)."""
        span = np.clip(np.searchsorted(self.at, where, side="right") - 1, 0, len(self.at) - 2)
        step = (self.at[span + 1] - self.at[span])[..., None]
        t = (np.asarray(where) - self.at[span])[..., None]
        start, rate = self.slope[span], (self.points[span + 1] - self.points[span]) / step
        cubic = (start + self.slope[span + 1] - 2.0 * rate) / step**2
        square = (rate - start) / step - cubic * step
        if derivative == 0:
            return self.points[span] + t * (start + t * (square + t * cubic))
        if derivative == 1:
            return start + t * (2.0 * square + 3.0 * t * cubic)
        return 2.0 * square + 6.0 * t * cubic
