"""What the whole program leaves of a gear: depth, face width, feed marks."""

import math
from collections.abc import Iterator

import numpy as np

from controller.laws.gearbox import SyncKind
from twin.advice.advice import Advice
from twin.advice.gear_law import feed_mark
from twin.advice.kinds import Kind
from twin.advice.limits import limit_of, pitch_diameter
from twin.advice.moment import Engagement
from twin.advice.scene import Scene
from twin.advice.stock import TOUCHING, Stock
from twin.cutters.hob import Hob
from twin.inspection.nominal import GearNominal

_PASS_MM = 0.05
"""[mm] places less deep than this belong to the same pass as the deepest: crowning, taper"""


def judge_gear_end(scene: Scene, engagement: Engagement | None, stock: Stock) -> Iterator[Advice]:
    """Advice on the depth of the teeth and on the part of the face width that has it."""
    deepest = int(stock.radius.argmin())
    least = float(stock.radius[deepest])
    if stock.blank_radius - least <= TOUCHING:
        if engagement:
            yield Advice(
                kind=Kind.NOTHING_CUT,
                found=f"nothing cut of the blank of {2.0 * stock.blank_radius:g} mm",
                span=engagement.span,
            )
        return
    nominal = scene.job.nominal
    hobbing = engagement is not None and engagement.gear.kind is SyncKind.HOBBING
    if not hobbing or not isinstance(nominal, GearNominal):
        return
    root = _root_diameter(nominal)
    limit = limit_of(nominal, "runout", share=1.0)
    error = 1000.0 * (least - root / 2.0)
    if abs(error) > limit.um:
        side = "shallow" if error > 0.0 else "deep"
        found = f"X{2.0 * least:.3f} at the deepest: {abs(error):.0f} µm too {side}, more than {limit.reason}"
        yield Advice(
            kind=Kind.DEPTH, found=found, span=stock.cause[deepest], valid=f"X{root:.3f}", value=error
        )
    yield from _coverage(nominal, stock, least, max(_PASS_MM, limit.um / 1000.0))


def _coverage(nominal: GearNominal, stock: Stock, least: float, margin: float) -> Iterator[Advice]:
    """The hob leaves its run-out on the part unless its middle has passed the face by as much."""
    face = _on_face(nominal, stock)
    missing = face & (stock.radius > least + margin)
    if not missing.any():
        return
    first, last = float(stock.z[missing].max()), float(stock.z[missing].min())
    low = float(stock.z[face].min())
    found = f"full depth is missing from Z{first:.1f} to Z{last:.1f} of the face Z0 to Z{low:g}"
    deep = np.flatnonzero(face & ~missing)
    edge = deep[np.argmin(np.abs(stock.z[deep] - first))] if len(deep) else int(stock.radius.argmin())
    share = float(missing.sum()) / float(face.sum())
    yield Advice(kind=Kind.FACE_NOT_COVERED, found=found, span=stock.cause[edge], value=share)


def judge_marks(scene: Scene, engagement: Engagement | None, stock: Stock) -> Iterator[Advice]:
    """Advice on the feed of the passes that leave the flanks: δ_x at the pitch point."""
    nominal = scene.job.nominal
    if engagement is None or not isinstance(nominal, GearNominal):
        return
    hob = engagement.mounted.tool
    finished = _on_face(nominal, stock) & (stock.radius < stock.radius.min() + _PASS_MM)
    if not isinstance(hob, Hob) or not finished.any():
        return
    worst = int(np.where(finished, stock.feed, -1.0).argmax())
    feed = float(stock.feed[worst])
    mark = 1000.0 * feed_mark(
        feed=feed,
        hob_radius=hob.pitch_diameter / 2.0,
        pressure=math.radians(nominal.normal_pressure_angle_deg),
        helix=math.radians(nominal.helix_angle_deg),
    )
    limit = limit_of(nominal, "helix_form")
    if mark > limit.um:
        found = f"marks of {mark:.1f} µm at {feed:.3f} mm per turn of the work, more than {limit.reason}"
        valid = f"at most {feed * math.sqrt(limit.um / mark):.2f} mm per turn of the work"
        yield Advice(kind=Kind.FEED_MARKS, found=found, span=stock.cause[worst], valid=valid, value=mark)


def _root_diameter(nominal: GearNominal) -> float:
    """d_f = d − 2 m_n (h_fP − x) [mm], with the addendum of the hob."""
    clearance = nominal.dedendum_factor - nominal.profile_shift
    return pitch_diameter(nominal) - 2.0 * nominal.normal_module_mm * clearance


def _on_face(nominal: GearNominal, stock: Stock) -> np.ndarray:
    """(n,) which places belong to the face width, from the front face."""
    width = nominal.face_width_mm or -float(stock.z[-1])
    return stock.z >= -width - 1e-9
