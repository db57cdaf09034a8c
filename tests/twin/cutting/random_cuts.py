"""Hypothesis strategies for tools and recorded-like motions, with what the brute-force evaluator needs."""

import math
from dataclasses import dataclass

import brute_force
import numpy as np
import synthetic_motion
from hypothesis import strategies as st

from twin.cutters.cutter import Cutter
from twin.cutters.disc_wheel import DiscWheel
from twin.cutters.hob import Hob
from twin.cutters.polygon_head import PolygonHead
from twin.cutting.fields import tool_field
from twin.cutting.motion import CutterMotion


@dataclass(frozen=True, slots=True, kw_only=True)
class RandomCut:
    """A tool, its motion, and where stock stands."""

    cutter: Cutter
    motion: CutterMotion
    outlines: list
    pitch: float
    """of the outlines [mm], 0 = single"""
    radii: tuple[float, float]
    """of the stock within the tool's reach [mm]"""
    half_length: float
    """of the stock about z = 0 [mm]"""
    feature: float
    """size of a tooth or an insert [mm]"""
    gash_lead: float = math.inf
    """[mm], + right-hand"""
    hollow: bool = False
    """whether the outline has hollow corners: then the field inside is no distance, only positive"""

    chords: float = 0.0
    """how far a wheel's outline may stand out of its hollow arcs [mm]"""

    def truth(self, point):
        """Depth by the independent evaluator, and the instant [samples] of it."""
        if self.cutter.revolved:
            return brute_force.wheel_field(point, self.motion, self.outlines)
        return brute_force.field(point, self.motion, self.cutter, self.outlines, self.pitch, self.gash_lead)

    def field(self):
        """The kernel's field, for blocks that stand a feature out of the stock."""
        room = self.feature
        return tool_field(
            self.cutter,
            self.motion,
            self.radii[1] + 2 * room,
            (-self.half_length - room, self.half_length + room),
        )

    def points(self, n, seed):
        """(n, 3) random points of the stock."""
        rng = np.random.default_rng(seed)
        r, angle = rng.uniform(*self.radii, n), rng.uniform(0.0, 2.0 * math.pi, n)
        return np.column_stack(
            [r * np.cos(angle), r * np.sin(angle), rng.uniform(-self.half_length, self.half_length, n)]
        )


def between(low, high):
    return st.floats(low, high, allow_nan=False)


@st.composite
def hobbings(draw):
    """A hob of any hand, starts and length; a gear of any helix; about two millimetres of feed."""
    module = draw(between(1.0, 4.0))
    starts = draw(st.integers(1, 3))
    teeth = draw(st.integers(12, 40))
    helix = draw(between(-30.0, 30.0))
    hob = Hob(
        normal_module_mm=module,
        outside_diameter_mm=draw(between(12.0, 40.0)) * module,
        starts=starts,
        gashes=draw(st.integers(6, 15)),
        hand=draw(st.sampled_from(["right", "left"])),
        tip_radius_factor=draw(st.sampled_from([0.0, 0.1, 0.38])),
        length_mm=draw(st.sampled_from([None, 4.0 * module])),
        shift_mm=draw(st.sampled_from([0.0, 1.7 * module])),
        gash=draw(st.sampled_from(["straight", "helical"])),
        protuberance_mm=draw(st.sampled_from([0.0, 0.05 * module])),
        chamfer_height_mm=draw(st.sampled_from([0.0, 0.4 * module])),
    )
    root = module * (teeth / 2.0 / math.cos(math.radians(helix)) - 1.25)
    cutter, motion = synthetic_motion.hobbing(
        hob,
        teeth=teeth,
        helix_deg=helix,
        tip_x=root - draw(st.sampled_from([0.0, 0.0, 0.7])) * module,
        z=(module, -module),
        feed=draw(between(1.0, 4.0)),
        step_deg=draw(between(1.0, 15.0)),
        swivel_error=draw(st.sampled_from([0.0, 0.05])),
    )
    outlines, pitch, gash_lead = brute_force.hob_outlines(
        module=module,
        outside_diameter=hob.outside_diameter_mm,
        starts=starts,
        pressure_angle=20.0,
        addendum=1.25,
        tip_radius=hob.tip_radius_factor,
        dedendum=1.25,
        helical=hob.gash == "helical",
        protuberance=hob.protuberance_mm,
        chamfer=hob.chamfer_height_mm,
    )
    return RandomCut(
        cutter=cutter,
        motion=draw(spoiled(motion)),
        outlines=outlines,
        pitch=pitch,
        radii=(root - 0.5 * module, root + 2.3 * module),
        half_length=1.5 * module,
        feature=module,
        gash_lead=gash_lead if hob.hand == "left" else -gash_lead,
        hollow=hob.protuberance_mm > 0 or hob.chamfer_height_mm > 0,
    )


@st.composite
def hollow_hobbings(draw):
    """A hob of module 2 with hollow flanks, in one arc or in two, on a gear of any helix."""
    module, helix, teeth = 2.0, draw(between(-30.0, 30.0)), draw(st.integers(12, 40))
    profile = draw(st.sampled_from(HOLLOW))
    hob = Hob(
        normal_module_mm=module,
        outside_diameter_mm=70.0,
        gash=draw(st.sampled_from(["straight", "helical"])),
        profile=profile,
    )
    root = module * (teeth / 2.0 / math.cos(math.radians(helix)) - 1.25)
    cutter, motion = synthetic_motion.hobbing(
        hob,
        teeth=teeth,
        helix_deg=helix,
        tip_x=root,
        z=(module, -module),
        feed=draw(between(1.0, 4.0)),
        step_deg=draw(between(1.0, 15.0)),
        swivel_error=draw(st.sampled_from([0.0, 0.05])),
    )
    # gashes at right angles to the thread of the pitch cylinder, 65 mm
    lead = math.asin(module / 65.0)
    helical = hob.gash == "helical"
    pitch = math.pi * module * (math.cos(lead) if helical else 1.0 / math.cos(lead))
    return RandomCut(
        cutter=cutter,
        motion=draw(spoiled(motion)),
        outlines=brute_force.chain_outlines(profile, tip=35.0, land=True, pitch=pitch),
        pitch=pitch,
        radii=(root - 0.5 * module, root + 2.3 * module),
        half_length=1.5 * module,
        feature=module,
        gash_lead=-math.pi * 65.0 / math.tan(lead) if helical else math.inf,
        hollow=True,
    )


HOLLOW = (
    # flanks by 200 and by 20 mm, and foot and flank by hollow arcs that meet smoothly or at a hollow corner
    ((0.13, 0.0, 0.76), (0.843, 0.5, -200.0), (2.48, 5.0)),
    ((0.13, 0.0, 0.76), (0.843, 0.5, -20.0), (2.48, 5.0)),
    ((0.5, 0.0), (0.7, 0.3), (1.9, 4.0, -1.0), (2.7, 5.0)),
    ((0.13, 0.0, 0.76), (0.843, 0.5, -30.0), (2.0, 3.5, -3.0), (2.8, 5.0)),
)


INSERTS = (
    # a rounded nose on a wider shank, a stepped insert with an undercut, a pointed one with hollow flanks
    ((0.0, 0.0, 0.5), (0.5, 0.5), (0.6, 1.2), (1.4, 1.6)),
    ((0.4, 0.0), (0.4, 0.5), (1.0, 0.5), (1.0, 0.9), (0.7, 0.9), (0.7, 2.0)),
    ((0.2, 0.0, -1.5), (1.1, 1.1)),
)


@st.composite
def polygon_turnings(draw, shapes=((0.0, None), (0.4, None), *((0.0, profile) for profile in INSERTS))):
    """A head of one to three inserts at the ratios of geometry.md 3, plain or with a profile of its own.

    `shapes` are corner radii and profiles.
    """
    inserts, radius = draw(st.integers(1, 3)), draw(between(25.0, 60.0))
    corner, profile = draw(st.sampled_from(shapes))
    head = PolygonHead(inserts=inserts, tip_radius_mm=radius, corner_radius_mm=corner, profile=profile)
    across = draw(between(10.0, 30.0))
    cutter, motion = synthetic_motion.polygon_turning(
        head,
        ratio=draw(st.sampled_from([2, 3, 6, -3])),
        across_flats=across,
        work_turns=3,
        z=(1.0, -1.0),
        step_deg=draw(between(0.5, 5.0)),
    )
    return RandomCut(
        cutter=cutter,
        motion=draw(spoiled(motion)),
        outlines=brute_force.chain_outlines(profile, tip=radius)
        if profile
        else brute_force.insert_outlines(tip_radius=radius, width=2.0, corner_radius=corner),
        pitch=0.0,
        radii=(0.45 * across, 0.6 * across),
        half_length=2.0,
        feature=1.0,
        hollow=profile is not None,
    )


@st.composite
def spoiled(draw, motion):
    """The motion at a changing, stopping or reversing speed, with servo noise, past a badly clamped part."""
    n = len(motion.time_s)
    u = np.linspace(0.0, 1.0, n)
    way = draw(st.sampled_from(["steady", "changing", "stopping", "reversing"]))
    if way == "changing":
        speed = 0.3 + 0.6 * np.abs(np.sin(draw(between(1.0, 20.0)) * u))
        motion = synthetic_motion.at_speed(motion, speed * min(1.0, (n - 1.01) / speed.sum()))
    elif way == "stopping":
        # S down to zero within the cut, a dwell, S up again
        ramp = np.clip(np.abs(u - 0.5) * draw(between(8.0, 30.0)) - 0.5, 0.0, 1.0)
        motion = synthetic_motion.at_speed(motion, 0.99 * ramp)
    elif way == "reversing":
        speed = 1.2 * np.cos(math.pi * u * draw(between(0.6, 0.98)))
        motion = synthetic_motion.at_speed(motion, speed * (n - 2) / np.cumsum(speed).max())
    noise = draw(st.sampled_from([0.0, 1.0]))
    if noise:
        rng = np.random.default_rng(draw(st.integers(0, 1000)))
        motion = synthetic_motion.jittered(motion, rng)
    if draw(st.booleans()):
        motion = synthetic_motion.clamped(
            motion, eccentricity=draw(between(0.0, 0.4)), tilt=draw(between(0.0, 0.02))
        )
    return motion


WHEELS = (
    # rounded, hollow as for the flanks of a gear, stepped
    ((0.6, 0.0, 0.4), (1.0, 0.4), (1.9, 3.5)),
    ((0.5, 0.0, -9.0), (1.2, 2.5), (2.2, 3.5)),
    ((0.4, 0.0), (0.4, 1.5), (1.2, 1.5), (1.8, 3.5)),
)


@st.composite
def grindings(draw):
    """A form wheel on some gaps of a spur or helical gear."""
    teeth, helix = draw(st.integers(12, 30)), draw(between(-25.0, 25.0))
    diameter = draw(between(20.0, 120.0))
    profile = draw(st.sampled_from([None, *WHEELS]))
    module = 2.0
    wheel = DiscWheel(
        outside_diameter_mm=diameter,
        normal_module_mm=None if profile else module,
        profile=profile,
    )
    root = module * (teeth / 2.0 / math.cos(math.radians(helix)) - 1.25)
    cutter, motion = synthetic_motion.grinding(
        wheel,
        teeth=teeth,
        module=module,
        helix_deg=helix,
        tip_x=root,
        z=(0.6 * diameter, -0.6 * diameter),
        gaps=3,
        samples=draw(st.sampled_from([30, 200])),
    )
    chain = profile or draw_rack(module)
    return RandomCut(
        cutter=cutter,
        motion=draw(spoiled(motion)),
        outlines=brute_force.chain_outlines(chain, tip=diameter / 2.0),
        pitch=0.0,
        radii=(root - 0.3, root + 4.5),
        half_length=3.0,
        feature=1.0,
        hollow=profile is not None,
        chords=1e-4 if profile == WHEELS[1] else 0.0,
    )


def draw_rack(module):
    """The straight-sided wheel as a chain, worked out by hand for 20°, 1.25, 1.25 and 0.38 modules."""
    tan, cos, sin = math.tan(math.radians(20.0)), math.cos(math.radians(20.0)), math.sin(math.radians(20.0))
    r = 0.38 * module
    flat = math.pi * module / 4.0 - 1.25 * module * tan - r * (1.0 - sin) / cos
    end = math.pi * module / 4.0 + 1.25 * module * tan
    return ((flat, 0.0, r), (flat + r * cos, r * (1.0 - sin)), (end, 2.5 * module))


cuts = st.one_of(hobbings(), hollow_hobbings(), polygon_turnings(), grindings())
hollow_cuts = st.one_of(hollow_hobbings(), polygon_turnings(shapes=((0.0, INSERTS[2]),)))
"""hollow arcs in one bite with what is beside them"""
