"""Where the usable flank begins and ends: above fillet or undercut, below a tip chamfer or rounding.

Flanks and reliefs are nearly involutes; a chamfer or a fillet leaves the involute steeply, so the usable
flank is the stretch about its middle along which the deviation is not steep. How steep the flanks' own
roughness makes them, feed marks and facets, is found first, and steepness then looked for over a base long
enough to tell. A slight undercut is not steep, but at its corner material begins to lack against what the
flank above goes on to.
"""

import math
from dataclasses import dataclass

import numpy as np

from twin.inspection.reading import Placed, read_flanks
from twin.inspection.solid import Floats, Ints, Solid

POINTS = 960
"""at which the flank is looked at from root to tip"""
BASE = 3
"""points to both sides over which steepness is taken, at least"""
WIDEST = 0.05
"""and at most, as part of all points"""
STEEP = 0.06
"""deviation over roll length that is no flank's: three degrees and a half"""
MIDDLE = 0.6
"""from root to tip, this is always flank"""
ALIKE = 0.05
"""a tooth whose flank ends farther than this part of the flank from the usual end is a damaged tooth"""
ROUGH = (0.45, 0.7)
"""part of the way from root to tip over which the roughness is looked at"""
BODY = (0.35, 0.9)
"""part of the flank, from its start to its end, that no undercut reaches"""
LACKING = (1e-3, 5.0)
"""an undercut is deeper at the start than this [mm] and than so many times the band of the flank above"""
CORNER = (1e-4, 1.5)
"""and begins where this [mm] or so many times that band lacks"""
ABOVE = 0.25
"""part of the flank above a place that shows how it would go on below"""
GOES_ON = (1e-5, 3.0, 1e-3)
"""a flank that lacks less than this [mm] below where the nominal's undercut begins, or than so many times the
band of the flank above, has none; with a wider limit than the third [mm] that cannot be told"""
FOOT = 0.01
"""part of all points in which a fillet too slight for a steep end may reach above the start"""
ONWARD = 0.03
"""part of the flank above that, which shows how it would go on below"""
LEFT = (5e-5, 10.0, 2.5)
"""a fillet or an undercut leaves that by more than this [mm], than so many times the band of that part, and
than so many times the flanks' roughness"""
UNDERCUT = 0.01
"""an undercut lacks more than this against the roll length down to the start: half a degree"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Usable:
    """The usable flank in roll lengths [mm]."""

    start: float
    end: float
    undercut: bool
    """below the start material is lacking, not in excess"""
    chamfered: bool
    """it ends below the tip diameter"""


def steep_ends(roll: Floats, deviation: Floats) -> tuple[Ints, Ints]:
    """Return first and last index (n,) of the stretch about the middle that is flank.

    Args:
        roll: (m,) roll lengths, evenly spaced [mm].
        deviation: (n, m) of as many flanks [mm].

    """
    points, step = len(roll), roll[1] - roll[0]
    deviation = np.array([_without_holes(flank) for flank in deviation])
    band = _roughness(deviation)
    base = int(np.clip(math.ceil(band / (STEEP * step)), BASE, max(WIDEST * points, BASE)))
    limit = 2 * max(STEEP * base * step, band)
    middle = round(MIDDLE * (points - 1))
    flat = np.abs(deviation[:, 2 * base :] - deviation[:, : -2 * base]) <= limit  # NaN is steep
    steep = ~np.pad(flat, ((0, 0), (base, base)), mode="edge")
    below, above = steep[:, :middle][:, ::-1], steep[:, middle:]
    # steepness shows about a base before the corner that makes it
    first = np.where(below.any(axis=1), middle - below.argmax(axis=1), 0)
    last = np.where(above.any(axis=1), middle + above.argmax(axis=1) - 1, points - 1)
    band = max(band, STEEP * BASE * step)
    return (
        _as_far_as_level(deviation, first, band=band, reach=-2 * base),
        _as_far_as_level(deviation, last, band=band, reach=2 * base),
    )


def _without_holes(flank: Floats) -> Floats:
    """Return a flank (m,) with its inner holes bridged: they are no end of it."""
    there = np.flatnonzero(np.isfinite(flank))
    if len(there) in (0, len(flank)):
        return flank
    inner = slice(there[0], there[-1] + 1)
    bridged = flank.copy()
    bridged[inner] = np.interp(np.arange(len(flank))[inner], there, flank[there])
    return bridged


def _roughness(deviation: Floats) -> float:
    """Return the usual band [mm] of flanks (n, m) about their own bend, where every tooth has flank."""
    low, high = (round(part * deviation.shape[1]) for part in ROUGH)
    at = np.linspace(-1, 1, high - low)
    body = deviation[:, low:high]
    body = body[np.isfinite(body).all(axis=1)]
    if len(body) == 0:
        return 0.0
    bend = np.linalg.qr(np.vander(at, 3))[0]
    return float(np.median(np.ptp(body - body @ bend @ bend.T, axis=1)))


def _as_far_as_level(deviation: Floats, end: Ints, *, band: float, reach: int) -> Ints:
    """Move each end (n,) on by up to `reach` points while the flank keeps to the level of those before it."""
    points, sense = deviation.shape[1], 1 if reach > 0 else -1
    row = np.arange(len(end))[:, None]
    before = np.clip(end[:, None] - sense * np.arange(abs(reach)), 0, points - 1)
    level = np.median(deviation[row, before], axis=1)[:, None]
    beyond = np.clip(end[:, None] + sense * np.arange(abs(reach) + 1), 0, points - 1)
    left = ~(np.abs(deviation[row, beyond] - level) <= band)
    steps = np.where(left.any(axis=1), np.maximum(left.argmax(axis=1) - 1, 0), abs(reach))
    return np.clip(end + sense * steps, 0, points - 1)


def undercut_corner(roll: Floats, deviation: Floats, *, start: float, end: float) -> float | None:
    """Return the roll length [mm] at which an undercut meets the flank, or None.

    Args:
        roll: (m,) roll lengths [mm].
        deviation: (m,) of the usual flank [mm].
        start: roll length at which the flank should begin [mm].
        end: roll length at which it ends [mm].

    """
    there = np.isfinite(deviation)
    low, high = (start + part * (end - start) for part in BODY)
    body = there & (roll >= low) & (roll <= high)
    foot = there & (roll >= start) & (roll < low)
    if np.count_nonzero(body) < 10 or not foot.any():
        return None
    bend = np.polynomial.Polynomial.fit(roll[body], deviation[body], 2)
    band = float(np.ptp(deviation[body] - bend(roll[body])))
    lacking = bend(roll[foot]) - deviation[foot]
    beyond = np.flatnonzero(lacking > max(CORNER[0], CORNER[1] * band))
    if len(beyond) == 0 or lacking[0] < max(LACKING[0], LACKING[1] * band):
        return None
    corner = float(roll[foot][beyond[-1]])
    return corner if lacking[0] > UNDERCUT * (corner - start) else None


def usable_flank(solid: Solid, placed: Placed, *, root_radius: float, tip_diameter: float) -> Usable:
    """Find the usable flank of all teeth in the measuring plane.

    `tip_diameter` [mm] is where the shortest tooth ends.
    """
    gear = placed.gear
    form, tip = (float(gear.roll_length(d)) for d in (gear.form_diameter, tip_diameter))
    lowest = max(float(gear.roll_length(2 * root_radius)), 0.02 * gear.module)
    whole = Usable(start=form, end=tip, undercut=gear.undercut, chamfered=False)
    if tip - lowest < 0.1 * gear.module:
        return whole
    roll = np.linspace(lowest, lowest + 0.998 * (tip - lowest), POINTS)
    read = read_flanks(solid, placed, np.array([placed.middle]), gear.radius_at(roll))
    flanks, facets = (
        np.concatenate(table[:, 0].transpose(0, 2, 1)) / 1000 for table in (read.deviation, read.facet)
    )
    whole_ones = np.isfinite(flanks).sum(axis=1) > POINTS / 2
    flanks, facets = flanks[whole_ones], facets[whole_ones]
    if len(flanks) == 0:
        return whole
    first, last = steep_ends(roll, flanks)
    near = ALIKE * POINTS
    alike = np.abs(first - np.median(first)) <= near
    start_at = int(first[alike].max(initial=0))
    end_at = int(last[np.abs(last - np.median(last)) <= near].min(initial=POINTS - 1))
    step = roll[1] - roll[0]
    start, end = form, tip
    undercut = gear.undercut and _lacks_below(roll, flanks - facets, form)
    if end_at < POINTS - 1 - BASE:
        end = float(roll[end_at])
    if start_at > 0 and roll[start_at] > form + (2 * BASE + 1) * step:
        start = float(roll[min(start_at + 2 * BASE, POINTS - 1)])
        below = slice(max(start_at - 4 * BASE, 0), max(start_at - BASE, 1))
        undercut = bool(np.nansum(flanks[:, below] - flanks[:, [start_at + BASE]]) < 0)
    else:
        start = _above_fillets(roll, (flanks - facets)[alike], start)
    middle = flanks[:, round(MIDDLE * POINTS), None]
    corner = undercut_corner(roll, _median(flanks - middle), start=start, end=end)
    if corner is not None:
        start, undercut = float(corner + step), True
    return Usable(start=start, end=end, undercut=undercut, chamfered=end < tip)


def _lacks_below(roll: Floats, flanks: Floats, form: float) -> bool:
    """Whether the usual flank of (n, m) lacks material below the roll length `form` [mm], or ends there."""
    usual = _median(flanks)
    below, above = roll < form, (roll >= form) & (roll <= form + ABOVE * (roll[-1] - form))
    if not below.any() or not np.isfinite(usual[above]).all():
        return False
    if not np.isfinite(usual[below]).all():
        return True
    bend = np.polynomial.Polynomial.fit(roll[above], usual[above], 2)
    limit = max(GOES_ON[0], GOES_ON[1] * float(np.ptp(usual[above] - bend(roll[above]))))
    return limit > GOES_ON[2] or bool((bend(roll[below]) - usual[below]).max() > limit)


def _above_fillets(roll: Floats, flanks: Floats, start: float) -> float:
    """Return the roll length [mm] above all fillets and undercuts that end a little above `start`.

    They do where a sound gear stands off its axis: the flanks (n, m) are not all cut to the same radius.
    """
    at, foot = int(np.searchsorted(roll, start)), round(FOOT * len(roll))
    seen = flanks[:, at : at + foot + round(ONWARD * (len(roll) - at))]
    seen = seen[np.isfinite(seen).all(axis=1)]
    if seen.shape[1] < foot + 4 or len(seen) == 0:
        return start
    powers = np.vander(np.linspace(-1, 1, seen.shape[1]), 3)
    rest = seen - np.linalg.lstsq(powers[foot:], seen[:, foot:].T, rcond=None)[0].T @ powers.T
    limit = np.maximum(LEFT[1] * np.ptp(rest[:, foot:], axis=1), max(LEFT[0], LEFT[2] * _roughness(flanks)))
    left = np.flatnonzero((np.abs(rest[:, :foot]) > limit[:, None]).any(axis=0))
    return float(roll[at + left[-1] + 1]) if len(left) else start


def _median(flanks: Floats) -> Floats:
    """Return the median (m,) of flanks (n, m) that may have holes; NaN where more than half have."""
    return np.sort(flanks, axis=0)[len(flanks) // 2]  # NaN sorts last
