"""The circle through touched points: the patent's own formulas, and beside them the least squared distances.

Points are (X, Y) in the frame that turns with the work spindle: X_i = L_i cos γ_i, Y_i = L_i sin γ_i, where
γ_i is the angle of the probe *relative to the part*. If C turns the part by +c, that is γ = −c; with +c the
centre would come out mirrored (eccentricity.md).
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.probing.errors import ProbingError

Floats = NDArray[np.float64]

FEWEST = 3
"""points that make a circle"""
FLAT = 1e-6
"""Smallest part of the points' scatter that may lie across their line: below it they make no circle."""
ROUNDS = 50
"""of the Gauss-Newton iteration; three or four are usual"""
STILL = 1e-12
"""[mm] of a step that ends it"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Circle:
    """A circle in the plane."""

    x: float
    """of the centre [mm]"""
    y: float
    radius: float
    """[mm]"""

    @property
    def eccentricity(self) -> float:
        """Distance e of the centre from the origin, the axis of the work spindle [mm]."""
        return math.hypot(self.x, self.y)

    @property
    def phase(self) -> float:
        """Angle φ of the centre, counter-clockwise from +X [rad]; atan2 keeps the quadrant, which the
        original's arctan(x1/y1) loses."""
        return math.atan2(self.y, self.x)

    def residuals(self, points: Floats) -> Floats:
        """(n,) distances of points (n, 2) from the circle, + = outside [mm]."""
        return np.hypot(points[:, 0] - self.x, points[:, 1] - self.y) - self.radius

    def out_of_round(self, points: Floats) -> float:
        """Range of the residuals: the form of the band as touched [mm]."""
        return float(np.ptp(self.residuals(points)))


def touched_points(readings: Floats, work_angle: Floats) -> Floats:
    """(n, 2) points in the part's frame: formula (1) with γ = −C.

    `readings` (n,): the ball's tip from the work axis [mm], a radius; `work_angle` (n,): C [rad].
    """
    return np.column_stack([readings * np.cos(work_angle), -readings * np.sin(work_angle)])


def patent_circle(points: Floats) -> Circle:
    """The algebraic least-squares circle, by formulas (2) and (3) of the patent word for word.

    `points` (n, 2) [mm]. Raises ProbingError for fewer than three points and for points on one line.
    """
    _require(points)
    x, y = points.T
    n = len(points)
    a_ = n * (x * x).sum() - x.sum() * x.sum()
    b_ = n * (x * y).sum() - x.sum() * y.sum()
    c_ = n * (x**3).sum() + n * (x * y * y).sum() - (x * x + y * y).sum() * x.sum()
    d_ = n * (y * y).sum() - y.sum() * y.sum()
    e_ = n * (x * x * y).sum() + n * (y**3).sum() - (x * x + y * y).sum() * y.sum()
    a = (e_ * b_ - c_ * d_) / (a_ * d_ - b_ * b_)
    b = (a_ * e_ - b_ * c_) / (b_ * b_ - a_ * d_)
    c = -((x * x + y * y).sum() + a * x.sum() + b * y.sum()) / n
    return Circle(
        x=float(-a / 2.0), y=float(-b / 2.0), radius=math.sqrt(max(a * a / 4.0 + b * b / 4.0 - c, 0.0))
    )


def geometric_circle(points: Floats) -> Circle:
    """The circle with the least sum of squared distances, by Gauss-Newton from the algebraic one.

    Raises ProbingError as `patent_circle`, and where the iteration does not settle.
    """
    circle = patent_circle(points)
    for _ in range(ROUNDS):
        jacobian = _directions(circle, points)
        step, *_ = np.linalg.lstsq(jacobian, circle.residuals(points), rcond=None)
        circle = Circle(x=circle.x + step[0], y=circle.y + step[1], radius=circle.radius + step[2])
        if not np.isfinite(step).all() or circle.radius <= 0.0:
            break
        if np.abs(step).max() < STILL * max(circle.radius, 1.0):
            return circle
    raise ProbingError(
        f"no circle fits the {len(points)} touched points best",
        remedy="points all around the band, equally spaced",
    )


def centre_covariance(circle: Circle, points: Floats, scatter: float) -> Floats:
    """(2, 2) covariance of the centre [mm²]; every distance has the standard deviation `scatter` [mm]."""
    jacobian = _directions(circle, points)
    return np.multiply(scatter**2, np.linalg.inv(jacobian.T @ jacobian)[:2, :2])


def _directions(circle: Circle, points: Floats) -> Floats:
    """(n, 3) what a step of centre and radius takes from the residuals."""
    away = points - [circle.x, circle.y]
    return np.column_stack([away / np.hypot(away[:, 0], away[:, 1])[:, None], np.ones(len(points))])


def _require(points: Floats) -> None:
    """Raise ProbingError where the points make no circle."""
    if points.ndim != 2 or points.shape[1:] != (2,):
        raise ValueError(f"points: expected (n, 2), got {points.shape}")
    if not np.isfinite(points).all():
        raise ProbingError("a touched point is no finite number")
    if len(points) < FEWEST:
        raise ProbingError(
            f"{len(points)} touched point(s) make no circle", remedy=f"valid: {FEWEST} or more, all around"
        )
    along, across = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    if across <= FLAT * along or along == 0.0:
        raise ProbingError(
            f"the {len(points)} touched points lie on one line: {along:.4g} mm along it, "
            f"{across:.2g} mm across",
            remedy="points all around the band, equally spaced",
        )
