"""The axial profile of the wheel that leaves a wanted gap (geometry.md 4).

The wheel's axis u crosses the work's at the helix angle, its plane lies along the gap. Where wheel and gap
touch, the gap's normal stands at right angles to the wheel's own motion: n · (u × (p − c)) = 0. The gap is a
helicoid, the same at every height but for its turn, so each point of its transverse section touches the wheel
at one height z; Newton's method finds all of them at once. For a spur gear z = 0: the gap itself.
"""

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from msgspec import Meta
from numpy.typing import NDArray

from twin.cutters.disc_wheel import DiscWheel
from twin.cutters.rack import Chain
from twin.errors import InputError
from twin.grinding.gap import Gap, gap_of
from twin.inspection.involute import Involute, geometry
from twin.inspection.nominal import GearNominal

Floats = NDArray[np.float64]

BEYOND = 0.35
"""modules that the profile goes on beyond the gear's tips: room for a wheel off the gap's middle"""
FILLET_POINTS = 17
"""an odd number: arcs go through three of them"""
LINE_POINTS = 60
"""of a radial line below the involute, before its steps are chosen"""
FLANK_POINTS = 800
"""of the involute, before its steps are chosen"""
STEPS = 50
"""of Newton's method; four or five are usual"""
FOLD = 1e-6
"""[mm] by which a profile that goes down must go down"""
STILL = 1e-11
"""[mm] of a step that ends it"""


@dataclass(frozen=True, slots=True, kw_only=True)
class GapWheel:
    """`[tool] kind = "gap_wheel"`: a wheel dressed for the gaps of the job's nominal gear."""

    outside_diameter_mm: Annotated[float, Meta(gt=0)]
    tip_radius_factor: Annotated[float, Meta(gt=0, le=1)] = 0.38
    """fillet of the gap, in modules"""
    chord_um: Annotated[float, Meta(gt=0, le=50)] = 0.5
    """how far the dresser's straight steps may stand out of the true profile"""
    dressing_width_um: Annotated[float, Meta(ge=-1000, le=1000)] = 0.0
    """dressing error: each flank of the wheel stands out by so much, along the wheel's axis"""
    dressing_slope_um: Annotated[float, Meta(ge=-1000, le=1000)] = 0.0
    """dressing error: so much more half-width at the gear's tip than at its root, growing evenly"""
    swivel_deg: Annotated[float, Meta(ge=-90, le=90)] | None = None
    """setting angle, as the operator set it; None = the nominal helix angle, for which it is dressed"""

    def dressed(self, nominal: GearNominal) -> DiscWheel:
        """The disc wheel with the profile for the nominal's gaps. Raises InputError where no wheel can."""
        gear = geometry(nominal)
        gap = gap_of(gear, fillet_factor=self.tip_radius_factor)
        profile = wheel_profile(
            gap, gear, self.outside_diameter_mm / 2.0, chord=self.chord_um * 1e-3, beyond=BEYOND * gear.module
        )
        return DiscWheel(
            outside_diameter_mm=self.outside_diameter_mm,
            profile=self._misdressed(profile, gear),
            swivel_deg=self.swivel_deg,
        )

    def _misdressed(self, profile: Chain, gear: Involute) -> Chain:
        height = 0.5 * (gear.tip_diameter - gear.root_diameter)
        width, slope = self.dressing_width_um * 1e-3, self.dressing_slope_um * 1e-3
        return tuple((p[0] + width + slope * p[1] / height, *p[1:]) for p in profile)


def wheel_profile(gap: Gap, gear: Involute, radius: float, *, chord: float, beyond: float) -> Chain:
    """Profile of a wheel of `radius` [mm] with its tip on the gap's root: (half-width, depth[, arc radius]).

    Straight steps along the flank stay within `chord` [mm] of it; the profile ends `beyond` [mm] above the
    gear's tip. Raises InputError where the gap cannot be ground with such a wheel.
    """
    fillet, direction = gap.fillet(FILLET_POINTS)
    last = gap.roll_at(gear.tip_diameter / 2.0 + beyond)
    rolls = np.linspace(gap.first_roll, last, FLANK_POINTS)
    flank, upward = gap.flank(rolls)
    line = np.linspace(fillet[-1], flank[0], LINE_POINTS)[1:-1]
    points = np.vstack([fillet, line, flank])
    tangents = np.vstack([direction, np.broadcast_to(upward[0], line.shape), upward])
    half, rho = touching(points, tangents, gear.twist, gear.helix, gap.root_radius + radius)
    form = gap.roll_at(gear.form_diameter / 2.0)
    usable = np.concatenate([np.zeros(len(fillet) + len(line), dtype=bool), rolls >= form])
    kept, slender = _as_wheel(half, radius - rho, usable, radius)
    depth = radius - rho[kept]
    depth[0] = 0.0
    arcs: list[tuple[float, ...]] = []
    if np.array_equal(slender[:FILLET_POINTS], half[:FILLET_POINTS]):
        for k in range(0, FILLET_POINTS - 1, 2):
            bulge = _radius(slender[k : k + 3], depth[k : k + 3])
            arcs.append((float(slender[k]), float(depth[k]), bulge))
        slender, depth = slender[FILLET_POINTS - 1 :], depth[FILLET_POINTS - 1 :]
    steps = _steps(np.column_stack([slender, depth]), chord)
    return (*arcs, *((float(h), float(d)) for h, d in zip(slender[steps], depth[steps], strict=True)))


def touching(
    points: Floats, tangents: Floats, twist: float, swivel: float, distance: float
) -> tuple[Floats, Floats]:
    """Where points of a gap's transverse section touch the wheel: |axial position| and radius there [mm].

    `points`, `tangents` (n, 2) of the section at height 0, the gap about +X; `twist` of the gap [rad/mm];
    wheel axis at `swivel` [rad] to −Y, its centre at `distance` [mm] on +X. Raises InputError where the
    iteration does not settle.
    """
    a, b = points.T
    da, db = tangents.T
    lead = twist * (a * da + b * db)
    cosine, sine = math.cos(swivel), math.sin(swivel)

    def condition(z: Floats) -> tuple[Floats, Floats]:
        """n · (u × (p − c)) in the frame that turns with the section, and its rate with z."""
        cos, sin = np.cos(twist * z), np.sin(twist * z)
        value = (
            db * (-cosine * cos * z - sine * (b + distance * sin))
            - da * (sine * (a - distance * cos) + cosine * sin * z)
            + lead * cosine * (a * cos - b * sin - distance)
        )
        rate = (
            db * (cosine * (twist * sin * z - cos) - sine * distance * twist * cos)
            - da * (sine * distance * twist * sin + cosine * (twist * cos * z + sin))
            - lead * cosine * twist * (a * sin + b * cos)
        )
        return value, rate

    z = np.zeros(len(a))
    for _ in range(STEPS):
        value, rate = condition(z)
        step = value / rate
        z = z - step
        if not np.isfinite(z).all() or np.abs(step).max() < STILL:
            break
    if not np.isfinite(z).all() or np.abs(condition(z)[0]).max() > 1e-6:
        raise InputError(
            "no wheel of this size touches the gap all along its profile", remedy="another wheel diameter"
        )
    cos, sin = np.cos(twist * z), np.sin(twist * z)
    away = np.stack([a - distance * cos, b + distance * sin, z])
    along = -cosine * sin * away[0] - cosine * cos * away[1] + sine * away[2]
    return np.abs(along), np.sqrt((away**2).sum(axis=0) - along**2)


def _steps(points: Floats, chord: float) -> NDArray[np.int64]:
    """Which of the points (n, 2) make a chain of longest steps that no point between is off by `chord`."""
    chosen = [0]
    while chosen[-1] < len(points) - 1:
        here = chosen[-1]
        ends = np.arange(here + 1, len(points))
        # the reach of a step is found by halving: a longer one strays further
        low, high = 0, len(ends) - 1
        while low < high:
            middle = (low + high + 1) // 2
            low, high = (
                (middle, high) if _strays(points[here : ends[middle] + 1]) <= chord else (low, middle - 1)
            )
        chosen.append(int(ends[low]))
    return np.array(chosen)


def _strays(points: Floats) -> float:
    """Largest distance of points (n, 2) from the line through the first and the last."""
    way = points[-1] - points[0]
    off = points - points[0]
    return float(np.abs(way[0] * off[:, 1] - way[1] * off[:, 0]).max() / np.hypot(*way))


def _radius(half: Floats, depth: Floats) -> float:
    """Radius of the circle through three points; 0 where they lie straight."""
    (ax, bx, cx), (ay, by, cy) = half, depth
    across = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    sides = math.hypot(bx - ax, by - ay) * math.hypot(cx - bx, cy - by) * math.hypot(cx - ax, cy - ay)
    return 0.0 if abs(across) < 1e-12 else float(sides / (2.0 * abs(across)))


def _as_wheel(
    half: Floats, depth: Floats, usable: NDArray[np.bool_], radius: float
) -> tuple[NDArray[np.int64], Floats]:
    """Points of the profile that go down from the tip, and half-widths there that never shrink.

    Where the touched places fold back, the wheel must stay within all of them: it is made more slender, and
    leaves a little more in the fillet. Raises InputError where that would touch the `usable` flank.
    """
    kept = [len(depth) - 1]
    for k in range(len(depth) - 2, -1, -1):
        if FOLD < depth[k] < depth[kept[-1]] - FOLD or k == 0:
            kept.append(k)
    kept = np.array(kept[::-1])
    slender = np.minimum.accumulate(half[kept][::-1])[::-1]
    lost = np.setdiff1d(np.flatnonzero(usable), kept[slender >= half[kept] - FOLD])
    if len(lost):
        raise InputError(
            f"a wheel of Ø {2 * radius:g} mm cannot grind this gap: its profile folds back "
            f"{depth[lost].max():.3f} mm below its tip",
            remedy="a smaller wheel, a larger fillet or a smaller helix angle",
        )
    return kept, slender
