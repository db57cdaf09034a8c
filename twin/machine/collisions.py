"""Collisions of what moves with the tool against what stands and what turns with the work.

What turns is given as bodies of revolution, so only slides change a distance, and no distance between two
bodies changes faster than they slide: from a place with clearance d nothing can touch before they have slid
by d. So a whole run takes some hundred distances, and the first tick that touches is found exactly.
"""

# pyright: reportAttributeAccessIssue=false

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import mujoco  # its bindings are compiled and carry no types
import numpy as np

from controller.clock import Chunk, Feedback, Floats, Load, Machine, MachineAlarm
from twin.machine.assembly import Assembly

MM = 1e-3
FAR = 10.0
"""[m] beyond which a distance need not be known"""
CUTS = ("cutter", "blank")
"""the one pair of bodies that is meant to meet"""


@dataclass(slots=True, kw_only=True)
class _Pair:
    """Two shapes, and the last place of the slides at which their distance was looked up."""

    moving: int
    fixed: int
    slides: Floats
    """(axes, 3) travel of the moving shape per travel of an axis [m/mm]"""
    place: Floats
    """(3,) [m]"""
    clearance: float = 0.0
    """[m] at that place"""


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
        change = np.flatnonzero(np.diff(chunk.tool[: feedback.ticks])) + 1
        for begin, end in pairwise([0, *change.tolist(), feedback.ticks]):
            if begin == end:
                break
            shapes = self._shapes.get(int(chunk.tool[begin]), self._first)
            touch = shapes.first_touch(feedback.actual[begin:end])
            if touch is not None:
                tick, words = touch
                return _ended(feedback, begin + tick + 1, words)
        return feedback

    def rest(self, ticks: int) -> None:
        """Let `ticks` pass in which nothing moves."""
        self._machine.rest(ticks)


class _Shapes:
    """The shapes of one machine as mounted that may come to touch."""

    def __init__(self, assembly: Assembly) -> None:
        self._model = assembly.model
        self._data = mujoco.MjData(assembly.model)
        self._qpos = [int(assembly.model.joint(j).qposadr[0]) for j in assembly.joints]
        self.pairs = _pairs(assembly)
        # no shape goes further than the slides together, whichever of them carry it
        travel = [np.linalg.norm(pair.slides, axis=1) for pair in self.pairs]
        self._travel = np.max(travel, axis=0) if travel else np.zeros(len(assembly.joints))
        self._place = np.zeros(len(assembly.joints))
        self._clearance = 0.0
        """[m] that every pair has at that place of the axes, at least"""

    def first_touch(self, actual: Floats) -> tuple[int, str] | None:
        """Row of (n, axes) positions in which two of them first touch, and what is to be said of it."""
        if not self.pairs or (np.abs(actual - self._place) @ self._travel).max() < self._clearance:
            return None
        hits = [
            (tick, k)
            for k, pair in enumerate(self.pairs)
            if (tick := self._touch_of(pair, actual)) is not None
        ]
        if hits:
            tick, k = min(hits)
            return tick, self._words(self.pairs[k])
        path = [actual[-1] @ pair.slides - pair.place for pair in self.pairs]
        left = [
            pair.clearance - float(np.linalg.norm(way)) for pair, way in zip(self.pairs, path, strict=True)
        ]
        self._place, self._clearance = actual[-1].copy(), min(left)
        return None

    def _touch_of(self, pair: _Pair, actual: Floats) -> int | None:
        """Row of (n, axes) positions in which the pair first touches."""
        path = actual @ pair.slides
        first = 0
        while first < len(path):
            moved = np.linalg.norm(path[first:] - pair.place, axis=1) >= pair.clearance
            if not moved.any():
                return None
            first += int(np.argmax(moved))
            pair.place = path[first]
            pair.clearance = self.distance(pair, actual[first])
            if pair.clearance <= 0.0:
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
        moving, fixed = (
            self._model.body(self._model.geom_bodyid[g]).name.replace("_", " ")
            for g in (pair.moving, pair.fixed)
        )
        return moving, fixed

    def _words(self, pair: _Pair) -> str:
        moving, fixed = self._names(pair)
        return f"{moving} touches {fixed}"


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
            pairs.append(_Pair(moving=moving, fixed=fixed, slides=travel[moving], place=np.zeros(3)))
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
