"""Collisions of what moves with the tool against what stands and what turns with the work.

What turns is given as bodies of revolution, so only slides change a distance, and no distance between two
bodies changes faster than they slide: from a place with clearance d nothing can touch before they have slid
by d. So a whole run takes some hundred distances, and the first tick that touches is found exactly.
"""

# pyright: reportAttributeAccessIssue=false

import copy
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import mujoco  # its bindings are compiled and carry no types
import numpy as np
from numpy.typing import NDArray

from controller.clock import Chunk, Feedback, Floats, Load, Machine, MachineAlarm
from twin.machine.assembly import Assembly
from twin.machine.silhouette import shape_name

MM = 1e-3
FAR = 10.0
"""[m] beyond which a distance need not be known"""
CUTS = ("cutter", "blank")
"""the one pair of bodies that is meant to meet"""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Pair:
    """Two shapes of the model."""

    moving: int
    fixed: int
    slides: Floats
    """(axes, 3) travel of the moving shape per travel of an axis [m/mm]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Touch:
    """Where two bodies touch, or come closest."""

    bodies: tuple[str, str]
    """what moves with the tool, what does not"""
    point: Floats
    """(3,) [mm] in the part frame at C0"""


def touch_at(assembly: Assembly, axes: Floats) -> Touch | None:
    """The two bodies that are closest with the slides at (axes,) positions; None where nothing can touch."""
    shapes = _Shapes(assembly)
    if not shapes.pairs:
        return None
    pair = min(shapes.pairs, key=lambda one: shapes.distance(one, axes))
    return shapes.touch(pair, axes)


class Guarded:
    """A machine that stops with an alarm at the first tick in which two of its bodies touch."""

    def __init__(self, machine: Machine, mounted: Assembly | Mapping[int, Assembly]) -> None:
        """`mounted`: the machine as it stands, or by tool number as it stands with each tool in the spindle,
        the first one also for tools that are not among them."""
        self._machine = machine
        by_tool = mounted if isinstance(mounted, Mapping) else {0: mounted}
        self._shapes = {tool: _Shapes(assembly) for tool, assembly in by_tool.items()}
        self._first = next(iter(self._shapes.values()))

    def advance(self, chunk: Chunk, load: Load | None = None) -> Feedback:
        """Move along the chunk up to its end, or to the tick of the first collision."""
        feedback = self._machine.advance(chunk, load)
        for begin, end in _stretches(chunk.tool[: feedback.ticks]):
            shapes = self._shapes.get(int(chunk.tool[begin]), self._first)
            touch = shapes.first_touch(feedback.actual[begin:end])
            if touch is not None:
                tick, words = touch
                return _ended(feedback, begin + tick + 1, words)
        return feedback

    def rest(self, ticks: int) -> None:
        """Let `ticks` pass in which nothing moves."""
        self._machine.rest(ticks)

    def __deepcopy__(self, memo: dict[int, object]) -> "Guarded":
        """Another machine in the same state; what is known of distances is common to both."""
        other = Guarded.__new__(Guarded)
        memo[id(self)] = other
        other._machine = copy.deepcopy(self._machine, memo)
        other._shapes, other._first = self._shapes, self._first
        return other


class _Shapes:
    """The shapes of one machine as mounted that may come to touch."""

    def __init__(self, assembly: Assembly) -> None:
        self._model = assembly.model
        self._data = mujoco.MjData(assembly.model)
        self._qpos = [int(assembly.model.joint(j).qposadr[0]) for j in assembly.joints]
        self.pairs = _pairs(assembly)
        self._slides = np.array([pair.slides for pair in self.pairs]).reshape(-1, len(assembly.joints), 3)
        """(pairs, axes, 3) [m/mm]"""
        self._travel = np.linalg.norm(self._slides, axis=2)
        self._fastest = self._travel.max(axis=0, initial=0.0)
        self._place = np.zeros_like(self._travel)
        """(pairs, axes) at which a pair's distance was last looked up"""
        self._clearance = np.zeros(len(self.pairs))
        """(pairs,) [m] that it had there"""
        self._stood = np.zeros(len(assembly.joints))
        self._free = -1.0
        """[m] that every shape may go from where the axes stood last"""

    def first_touch(self, actual: Floats) -> tuple[int, str] | None:
        """Row of (n, axes) positions in which two of them first touch, and what is to be said of it."""
        if not self.pairs or not len(actual):
            return None
        if (np.abs(actual - self._stood).max(axis=0) @ self._fastest) < self._free:
            return None
        # no shape goes further than to the middle of all positions, and from there by half their extent
        low, high = actual.min(axis=0), actual.max(axis=0)
        middle = ((low + high) / 2 - self._place)[:, None, :] @ self._slides
        furthest = np.sqrt((middle**2).sum(axis=(1, 2))) + self._travel @ ((high - low) / 2)
        near = np.flatnonzero(furthest >= self._clearance)
        hits = [(tick, k) for k in near.tolist() if (tick := self._touch_of(k, actual)) is not None]
        if not hits:
            self._stood = actual[-1].copy()
            way = (self._stood - self._place)[:, None, :] @ self._slides
            self._free = float((self._clearance - np.sqrt((way**2).sum(axis=(1, 2)))).min())
            return None
        tick, k = min(hits)
        return tick, self._words(self.pairs[k])

    def _touch_of(self, k: int, actual: Floats) -> int | None:
        """Row of (n, axes) positions in which a pair first touches."""
        pair, first = self.pairs[k], 0
        while first < len(actual):
            way = (actual[first:] - self._place[k]) @ pair.slides
            moved = np.einsum("ij,ij->i", way, way) >= self._clearance[k] ** 2
            if not moved.any():
                return None
            first += int(np.argmax(moved))
            self._place[k] = actual[first]
            self._clearance[k] = max(self.distance(pair, actual[first]), 0.0)
            if not self._clearance[k]:
                return first
            first += 1
        return None

    def distance(self, pair: _Pair, axes: Floats) -> float:
        """Distance [m] of the pair with the slides at (axes,) positions; spindles do not matter."""
        slides = np.abs(pair.slides).any(axis=1)
        self._data.qpos[self._qpos] = np.where(slides, axes * MM, 0.0)
        mujoco.mj_kinematics(self._model, self._data)
        return float(mujoco.mj_geomDistance(self._model, self._data, pair.moving, pair.fixed, FAR, None))

    def touch(self, pair: _Pair, axes: Floats) -> Touch:
        """The pair's bodies, and the middle between their closest points."""
        self.distance(pair, axes)
        between = np.zeros(6)
        mujoco.mj_geomDistance(self._model, self._data, pair.moving, pair.fixed, FAR, between)
        front = self._data.body("work").xpos
        point = (between.reshape(2, 3).mean(axis=0) - front) / MM
        return Touch(bodies=self._names(pair), point=point)

    def _names(self, pair: _Pair) -> tuple[str, str]:
        return shape_name(self._model, pair.moving), shape_name(self._model, pair.fixed)

    def _words(self, pair: _Pair) -> str:
        moving, fixed = self._names(pair)
        return f"{moving} touches {fixed}"


def _stretches(tool: NDArray[np.int16]) -> list[tuple[int, int]]:
    """First and one-past-last row of each stretch of (n,) tool numbers with the same one."""
    if not len(tool):
        return []
    if (tool == tool[0]).all():
        return [(0, len(tool))]
    change = np.flatnonzero(tool[1:] != tool[:-1]) + 1
    return list(pairwise([0, *change.tolist(), len(tool)]))


def _ended(feedback: Feedback, ticks: int, words: str) -> Feedback:
    """The feedback up to the tick of a collision."""
    return Feedback(
        ticks=ticks,
        setpoint=feedback.setpoint[:ticks],
        actual=feedback.actual[:ticks],
        measured=None if feedback.measured is None else feedback.measured[:ticks],
        alarms=(MachineAlarm(number="HT9030", axis=None, found=words),),
    )


def _pairs(assembly: Assembly) -> list[_Pair]:
    """Every shape that slides with every one that does not, but for neighbours and what is meant to cut."""
    model = assembly.model
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    travel = [_travel(assembly, data, int(body)) for body in model.geom_bodyid]
    pairs = []
    for moving in range(model.ngeom):
        for fixed in range(model.ngeom):
            bodies = [int(model.geom_bodyid[g]) for g in (moving, fixed)]
            names = tuple(model.body(b).name for b in bodies)
            filtered = not (
                model.geom_contype[moving] & model.geom_conaffinity[fixed]
                or model.geom_contype[fixed] & model.geom_conaffinity[moving]
            )
            if (
                filtered
                or not travel[moving].any()
                or travel[fixed].any()
                or model.body_parentid[bodies[0]] == bodies[1]
                or names == CUTS
            ):
                continue
            pairs.append(_Pair(moving=moving, fixed=fixed, slides=travel[moving]))
    return pairs


def _travel(assembly: Assembly, data: mujoco.MjData, body: int) -> Floats:
    """(axes, 3) how far a body goes per travel of every axis [m/mm]; nothing where an axis turns."""
    model = assembly.model
    travel = np.zeros((len(assembly.joints), 3))
    while body > 0:
        for k, name in enumerate(assembly.joints):
            joint = model.joint(name)
            if joint.bodyid[0] == body and joint.type[0] == mujoco.mjtJoint.mjJNT_SLIDE:
                travel[k] = data.xaxis[joint.id] * MM
        body = int(model.body_parentid[body])
    return travel
