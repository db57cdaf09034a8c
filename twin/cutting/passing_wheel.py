"""A disc wheel in the part's frame, instant by instant."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from twin.cutters.profile import ToothProfile
from twin.cutting.motion import CutterMotion
from twin.kinematics import part_frame

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

TABLE = 6000
"""points of the wheel's half-width over its radius"""
STEP = 0.01
"""[mm] between two instants: the rim of a wheel of Ø 60 rises by 4e-7 mm between them"""
LOOKS = 32
"""instants of a stroke at which a point is looked at before the deepest is searched between"""


def standing_wheel(profile: ToothProfile) -> "PassingWheel":
    """A wheel that has not moved yet."""
    rho = profile.tip * (1.0 - 0.5 * np.linspace(1.0, 0.0, TABLE) ** 2)
    low, high = np.zeros(TABLE), np.full(TABLE, profile.half_width + 1e-9)
    for _ in range(50):
        middle = 0.5 * (low + high)
        inside = profile.depth(middle, rho)[0] > 0.0
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    low[-1] = low[-2]  # the land at the tip, on which no point is inside
    # beyond the tip it goes on falling, so that the way back to the wheel is uphill from anywhere
    rho, low = np.append(rho, 2.0 * profile.tip), np.append(low, low[-1] - profile.tip)
    nowhere = np.zeros((0, 3))
    return PassingWheel(
        profile=profile, time_s=nowhere[:, 0], centre=nowhere, axis=nowhere, rho=rho, half=low
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class PassingWheel:
    """The wheel in the part's frame, sample by sample."""

    profile: ToothProfile
    time_s: Floats
    """(n,)"""
    centre: Floats
    """(n, 3) [mm]"""
    axis: Floats
    """(n, 3)"""
    rho: Floats
    """(t,) radii, ascending, the last beyond the tip [mm]"""
    half: Floats
    """(t,) half-widths there, below 0 beyond the tip [mm]"""

    def along(self, motion: CutterMotion, run: tuple[int, int], radius: float) -> "PassingWheel":
        """The same wheel on a stretch of a motion, in steps of at most STEP past stock within `radius`."""
        part = slice(run[0], run[1] + 1)
        centre, work = motion.centre[part], motion.work_angle[part]
        way = np.linalg.norm(np.diff(centre, axis=0), axis=1) + radius * np.abs(np.diff(work))
        count = np.maximum(np.ceil(way / STEP), 1.0)
        at = np.interp(
            np.arange(count.sum() + 1.0), np.concatenate([[0.0], np.cumsum(count)]), np.arange(len(work))
        )
        own = np.arange(len(work), dtype=np.float64)
        finer = replace(
            motion,
            time_s=at,
            work_angle=np.interp(at, own, work),
            tool_angle=np.interp(at, own, motion.tool_angle[part]),
            centre=np.column_stack([np.interp(at, own, column) for column in centre.T]),
        )
        centre, axis, _ = part_frame(finer)
        return replace(self, time_s=np.interp(at, own, motion.time_s[part]), centre=centre, axis=axis)

    def level(self, points: Floats, sample: Ints) -> Floats:
        """Above 0 inside the wheel, at points (m, 3) and samples (m,)."""
        s, rho = self.seen(points, sample)
        return np.minimum(np.interp(rho, self.rho, self.half) - np.abs(s), self.profile.tip - rho)

    def seen(self, points: Floats, sample: Ints) -> tuple[Floats, Floats]:
        """Axial position and distance from the wheel's axis [mm]."""
        away = points - self.centre[sample]
        s = np.einsum("nx,nx->n", away, self.axis[sample])
        return s, np.sqrt(np.maximum(np.einsum("nx,nx->n", away, away) - s * s, 0.0))

    def uphill(self, points: Floats, sample: Ints, stride: int) -> tuple[Ints, Floats]:
        """The samples at which the points are deepest, uphill from `sample`, and how deep."""
        best = self.level(points, sample)
        while stride:
            for way in (stride, -stride):
                other = np.clip(sample + way, 0, self.last)
                level = self.level(points, other)
                up = level > best
                sample, best = np.where(up, other, sample), np.where(up, level, best)
            stride //= 2
        return sample, best

    def around(self, points: Floats, sample: Ints, reach: int, stride: int) -> tuple[Ints, Floats]:
        """The samples at which the points are deepest within `reach` of `sample`, and how deep: over every
        hump that is wider than `stride`, as drives leave them where a block ends."""
        best_at, best = sample, self.level(points, sample)
        for shift in range(-reach, reach + 1, stride):
            other = np.clip(sample + shift, 0, self.last)
            level = self.level(points, other)
            up = level > best
            best_at, best = np.where(up, other, best_at), np.where(up, level, best)
        return self.uphill(points, best_at, stride)

    def deepest(self, points: Floats) -> tuple[Ints, Floats]:
        """The samples at which the points are deepest, wherever they are, and how deep."""
        looks = np.unique(np.linspace(0, self.last, LOOKS).astype(np.int64))
        sample = np.full(len(points), looks[0])
        best = self.level(points, sample)
        for look in looks[1:]:
            level = self.level(points, np.full(len(points), look))
            up = level > best
            sample, best = np.where(up, look, sample), np.where(up, level, best)
        stride = max(int(np.diff(looks).max(initial=1)), 1)
        return self.uphill(points, sample, stride)

    @property
    def last(self) -> int:
        """The last instant."""
        return len(self.centre) - 1

    def held(self, points: Floats) -> Floats:
        """Depths (n,) of points (n, 3) of the cut at the deepest of all instants of a stroke [mm].

        Instant by instant, without regard to layers, rays or the search along them.
        """
        every = np.arange(self.last + 1)
        depth = np.zeros(len(points))
        for row, point in enumerate(points):
            level = self.level(np.broadcast_to(point, (len(every), 3)), every)
            best = every[level > level.max() - 1e-3]
            s, rho = self.seen(np.broadcast_to(point, (len(best), 3)), best)
            depth[row] = self.profile.depth(s, rho)[0].max()
        return depth
