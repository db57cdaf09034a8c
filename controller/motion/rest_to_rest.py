"""The short lane of motion: a straight move from rest to rest with nothing in its way, planned in one go.

Programs of a million blocks are made of these. What `travel` does step by step is done here with the same
arithmetic, to the bit (a test holds the two together); whatever is special about a move, or about the moment,
closes the lane and leaves the move to `travel`.
"""

import math

from controller.commands import Move
from controller.laws.inclined import Frame
from controller.motion.axes import Axes
from controller.motion.feeding import NO_SPEED
from controller.motion.limits import StrokeLimits
from controller.motion.path import NOTHING

_Way = tuple[int, float, float]
"""column, travel, where the slide stands"""


class ShortLane:
    """Knows whether the lane is open, and moves along it."""

    __slots__ = ("_axes", "_box", "_limits", "_motion", "_sampled")

    def __init__(self, motion: Axes) -> None:
        self._motion = motion
        self._axes = [(a.rapid, a.cutting, a.acceleration) for a in motion.machine.axes]
        self._sampled = not motion.circumstances.closed_form
        self._limits: StrokeLimits | None = None
        self._box: list[tuple[float, float]] | None = None
        """column -> limits of the slide; nothing stands within those of an axis that has to be travelled"""

    def move(self, command: Move) -> bool:
        """Make the move at once; False, and nothing has changed, where it has to be travelled."""
        motion, feed = self._motion, command.feed
        if (feed and feed.per_revolution) or not self._open():
            return False
        ways = self._ways(command)
        squares = 0.0
        for _, way, _ in ways:
            squares += way * way
        if squares < NOTHING or self._box is None:
            return False
        length, top, rate = math.sqrt(squares), math.inf, math.inf
        for k, way, here in ways:
            low, high = self._box[k]
            if not low <= here + way <= high:
                return False
            rapid, cutting, acceleration = self._axes[k]
            ratio = length / (way if way > 0.0 else -way)
            top = min(top, (cutting if feed else rapid) * ratio)
            rate = min(rate, acceleration * ratio)
        if feed:
            if not NO_SPEED < feed.value <= top:
                return False
            top = feed.value
        if motion.references.reached:
            motion.references.leave([k for k, _, _ in ways])
        begin = motion.time
        self._go(ways, length, min(top, math.sqrt(rate * length)), rate)
        if self._sampled and not feed:
            motion.timeline.go_rapid(begin, motion.time)
        shown, extents = motion.registers.absolute, motion.program_extents
        for k, way, _ in ways:
            shown[k] += way
        for k, target in command.absolute.items():
            shown[k] = target
        for k, _, _ in ways:
            extents.stretch(k, shown[k])
        return True

    def _ways(self, command: Move) -> list[_Way]:
        shown, tracks = self._motion.registers.absolute, self._motion.timeline.tracks
        ways: list[_Way] = []
        for k, target in command.absolute.items():
            way = target - shown[k]
            if way > NOTHING or way < -NOTHING:
                ways.append((k, way, tracks[k].rest))
        for k, way in command.incremental.items():
            if way > NOTHING or way < -NOTHING:
                ways.append((k, way, tracks[k].rest))
        return ways

    def _go(self, ways: list[_Way], length: float, peak: float, rate: float) -> None:
        """Speed up to `peak`, cruise, brake; where nothing is sampled only the end is laid down."""
        motion = self._motion
        ramp, run_up = peak / rate, peak * peak / (2.0 * rate)
        cruise = length - run_up - run_up
        begin = motion.time
        cruising = braking = begin + ramp
        if cruise > 0.0:
            braking = cruising + cruise / peak
        motion.time = end = braking + ramp
        tracks, peaks, extents, registers = (
            motion.timeline.tracks,
            motion.peaks,
            motion.slide_extents,
            motion.registers,
        )
        for k, way, here in ways:
            share, add = way / length, tracks[k].add
            if self._sampled:
                add(begin, here, 0.0, share * rate)
                if cruise > 0.0:
                    add(cruising, here + share * run_up, share * peak)
                    add(braking, here + share * (run_up + cruise), share * peak, share * -rate)
                else:
                    add(braking, here + share * run_up, share * peak, share * -rate)
            add(end, here + way)
            registers.relative[k] += way
            registers.cartesian[k] += way
            extents.stretch(k, here + way)
            peaks.speed[k] = max(peaks.speed[k], abs(share) * peak)
            peaks.acceleration[k] = max(peaks.acceleration[k], abs(share) * rate)

    def _open(self) -> bool:
        """Whether neither the operator, nor a spindle or gear box, nor an inclined pair has a say now."""
        motion, panel = self._motion, self._motion.panel
        if motion.limits is not self._limits:
            self._limits, self._box = motion.limits, self._only_box(motion.limits)
        return (
            self._box is not None
            and motion.agenda.next_time == math.inf
            and not motion.timeline.epochs
            and motion.spindles.surface is None
            and panel.running
            and not panel.inputs.levels
            and panel.feed_override == panel.rapid_override == 1.0
            and not (panel.dry_run or panel.locked)
        )

    def _only_box(self, limits: StrokeLimits) -> list[tuple[float, float]] | None:
        """The limits of the slides, where they are a single box on the program's own axes."""
        machine, areas = self._motion.machine, limits.areas
        if machine.pair or len(areas) != 1 or limits.plus or limits.minus or machine.parameters.bit(1301, 7):
            return None
        (area,) = areas
        if area.forbidden or area.frame is not Frame.SLIDES:
            return None
        nowhere = (math.inf, -math.inf)
        boxes = zip(machine.axes, area.lower, area.upper, strict=True)
        return [nowhere if axis.rotary else (low, high) for axis, low, high in boxes]
