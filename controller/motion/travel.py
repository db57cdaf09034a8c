"""Paths are travelled here: planned from where they stand, up to where something happens, and planned again.

Blocks end in exact stop. Time is continuous; a block may begin and end between two ticks. A move with feed
per revolution waits until the spindle has reached its commanded speed, then goes by the theoretical speed in
closed form or by the measured speed in periods of 8 ms; all other moves do not wait for spindles.
"""

import math
from dataclasses import dataclass, field
from enum import Enum

from controller.commands import Feed
from controller.interrupts import Reset
from controller.laws.gearbox import SyncKind
from controller.laws.segments import Phase, clip, trapezoid
from controller.motion.feeding import FEED_PERIOD, NO_SPEED, Gauge
from controller.motion.interlock import holds_back, induced_past_interlock
from controller.motion.path import NOTHING, AnyPath, stopping_point
from controller.motion.registers import TURN
from controller.motion.requests import SkipWatch, Steps, Touch
from controller.motion.settling import Settling
from controller.tables.alarms import Alarm, AlarmError, alarm

_SLOWED = 1.0 + 1e-9


class Manner(Enum):
    """How a path is travelled."""

    PROGRAM = "by the program"
    SKIP = "by the program, until the skip signal"
    THREAD = "bound to the spindle: no override, no hold"
    BY_HAND = "by hand: the program stands"


_HELD = frozenset({Manner.PROGRAM, Manner.SKIP})


class Travelling(Settling):
    """Travels paths."""

    def _travel(
        self, path: AnyPath | None, feed: Feed | None, manner: Manner = Manner.PROGRAM
    ) -> Steps[Touch | None]:
        """Go along a path to its end, through holds and overrides, or until the skip signal comes.

        Raises AlarmError at a stroke limit, Reset where RESET ends the motion.
        """
        if path is None:
            return None
        outer, self._underway = self._underway, path
        on_way = _OnWay(path=path, feed=feed, manner=manner)
        self._set_end(path, feed)
        self._note_interlock(path)
        while on_way.position < on_way.path.end:
            if self.agenda.next_time <= self.time:
                yield from self._operate()
            wanted, until, obstacle = yield from self._wanted(on_way)
            phases = _plan(on_way, wanted)
            if phases:
                yield from self._stretch(on_way, phases, until)
            elif on_way.touch or not (yield from self._wait_on_way(on_way, obstacle, until)):
                break
        self._arrive(on_way.path, on_way.position)
        self._underway = outer
        return on_way.touch

    def _stretch(self, on_way: "_OnWay", phases: list[Phase], until: float) -> Steps[None]:
        """Make the next stretch of a path, up to standstill or to where something happens."""
        path, tracks, begin = on_way.path, self.timeline.tracks, self.time
        until = min(until, self.agenda.next_time)
        for phase in phases:
            self.time += phase.duration
        standing = self.time <= until
        if not standing:
            phases, self.time = clip(phases, until - begin), until
        path.lay(tracks, phases, begin)
        if on_way.manner is Manner.SKIP and on_way.touch is None:
            answer = yield SkipWatch(begin)
            if isinstance(answer, Touch):
                on_way.touch, self.time, standing = answer, answer.time, False
                phases = clip(phases, answer.time - begin)
        if path.rapid:
            self.timeline.go_rapid(begin, self.time)
        on_way.position, on_way.speed = phases[-1].end, max(phases[-1].end_speed, 0.0)
        if standing:
            if path.end - on_way.position < NOTHING:
                on_way.position = path.end
            on_way.speed = 0.0
            path.stop(tracks, on_way.position, self.time)
        self._note_peaks(path, phases, begin)
        if self.spindles.surface and on_way.manner is not Manner.THREAD:
            self._follow_diameter(path, phases, begin)

    def _wait_on_way(self, on_way: "_OnWay", obstacle: str, until: float) -> Steps[bool]:
        """Stand on the path until it may go on; False where nothing is left of it."""
        self._settle(on_way.path, on_way.position)
        yield from self._pause(on_way, obstacle, until)
        if on_way.path.version == self._version:
            return True
        rest = self._rest(on_way.path, on_way.position)
        if rest is None:
            return False
        on_way.path, on_way.position = rest, 0.0
        self._underway = rest
        self._set_end(rest, on_way.feed)
        return True

    def _set_end(self, path: AnyPath, feed: Feed | None) -> None:
        """Where a stroke limit ends the path."""
        crossing = path.crossing
        if crossing:
            top = self._top(path, path.top_speed)
            wanted = top if feed is None or feed.per_revolution else feed.value
            end = stopping_point(
                path.length,
                crossing.fraction * path.length,
                min(wanted, top),
                path.acceleration,
                before=crossing.before,
            )
            path.end = min(end, crossing.wall * path.length)

    # What stands in the way, and what to do then

    def _obstacle(self, path: AnyPath, manner: Manner) -> str:
        """Why the path has to stop where it is; empty where it need not."""
        if self._reset:
            return "RESET"
        if path.version != self._version:
            return "a change of the machine"
        if not self.panel.running and manner in _HELD and not self._only_in_sync(path):
            return "a hold"
        if not (self.panel.feed_override or path.rapid or self.panel.dry_run) and manner in _HELD:
            return "a feed of 0 by its override"
        lacking = holds_back(self.panel.inputs, path.commanded, path.slides)
        return f"a block that waits for {lacking}" if lacking else ""

    def _note_interlock(self, path: AnyPath) -> None:
        """An interlock of the orthogonal axis does not stop what the inclined axis induces (*ITx, 注意)."""
        pair, inputs, span = self.machine.pair, self.panel.inputs, self._span
        if (
            inputs.levels
            and span
            and (note := induced_past_interlock(inputs, pair, path.commanded, path.slides, span))
        ):
            self._warn(note)

    def _only_in_sync(self, path: AnyPath) -> bool:
        """Feed hold does not act on master and slave of a gear box (hobbing, 注意事项)."""
        gear = self.coupling.gear
        return gear is not None and all(k in (gear.master, gear.slave) for k in path.commanded)

    def _pause(self, on_way: "_OnWay", obstacle: str, until: float) -> Steps[None]:
        """The path stands: wait for what will let it go on."""
        if self._reset:
            raise Reset
        if on_way.path.version != self._version:
            return
        if not self.panel.running and on_way.manner in _HELD and obstacle:
            yield from self._stand("a hold within a block")
        elif until < math.inf:
            yield from self._wait(until)
        else:
            yield from self._await_operator(obstacle)

    # How fast

    def _wanted(self, on_way: "_OnWay") -> Steps[tuple[float, float, str]]:
        """The path speed that is wanted now [1/s], until when that holds [s], and what else stops the path.

        Raises AlarmError, and the path stands, where the feed hangs on a spindle that does not turn."""
        path = on_way.path
        if on_way.touch:
            return 0.0, math.inf, "the skip signal"
        if obstacle := self._obstacle(path, on_way.manner):
            return 0.0, math.inf, obstacle
        try:
            if self._by_encoder(on_way.feed):
                yield from self._measure(on_way.gauge)
            wanted, until = self._pace(on_way, self._top(path, on_way.speed))
        except AlarmError:
            path.stop(self.timeline.tracks, on_way.position, self.time)
            self._settle(path, on_way.position)
            raise
        return wanted, until, ""

    def _pace(self, on_way: "_OnWay", top: float) -> tuple[float, float]:
        """The path speed that is wanted now [1/s], at most `top`, and until when that holds [s]."""
        path, feed, manner, gauge = on_way.path, on_way.feed, on_way.manner, on_way.gauge
        until = math.inf
        panel = self.panel
        if feed is None:
            return self._rapid(path, top), until
        if manner in (Manner.THREAD, Manner.BY_HAND):
            wanted = feed.value
        elif panel.dry_run:
            wanted = self._dry_speed
        elif feed.per_revolution:
            turns, until = (gauge.turns, gauge.until) if self._by_encoder(feed) else self._theoretical()
            wanted = feed.value * turns * panel.feed_override
        else:
            wanted = feed.value * panel.feed_override
        if wanted > top:
            if wanted > top * _SLOWED and not path.slowed:
                path.slowed = True
                self._warn_slowed(wanted, top)
            wanted = top
        return wanted, until

    @property
    def _dry_speed(self) -> float:
        """Parameter 1410 [1/s]."""
        return self.machine.parameters.number(1410) / 60.0

    def _rapid(self, path: AnyPath, top: float) -> float:
        """Rapid speed by its override; F0 is the speed of parameter 1421."""
        override = self.panel.rapid_override
        if override > 0.0:
            return top * override
        number, axes = self.machine.parameters.number, self.machine.parameters.letters
        slowest = min(number(1421, axes[k]) / 60.0 / abs(share) for k, share in path.shares.items() if share)
        return min(top, slowest)

    def _warn_slowed(self, wanted: float, top: float) -> None:
        possible = f"{top * 60.0:.0f}" if top * 60.0 >= 10.0 else f"{top * 60.0:.3g}"
        found = f"{wanted * 60.0:.0f} mm/min asked for, {possible} possible on this path"
        self._warn(Alarm(number="HT9107", found=found, span=self._span))

    def _by_encoder(self, feed: Feed | None) -> bool:
        """Whether the feed goes by the measured speed. In a dry run the machine is ideal: at constant speed
        the measured speed is the commanded one."""
        if feed is None or not feed.measured or self.panel.dry_run:
            return False
        return not self.circumstances.closed_form or self.spindles.surface is not None

    def _await_turning(self, feed: Feed) -> Steps[None]:
        """A feed per revolution waits for the spindle's speed; by the encoder, for the tick of a reading."""
        if not self.panel.dry_run:
            yield from self._ready(self._driven_axis())
            if feed.measured:
                yield from self._to_tick()

    def _theoretical(self) -> tuple[float, float]:
        """Turns per second of the work axis as commanded, and until when they stay [s]."""
        axis = self._feed_axis()
        turns = abs(self.timeline.speed(axis, self.time)) / TURN
        if self.spindles.ready(self._driven_axis(), self.time) > self.time:
            return turns, self.time + FEED_PERIOD
        if turns == 0.0:
            raise self._standstill("the work axis stands still")
        return turns, math.inf

    def _measure(self, gauge: Gauge) -> Steps[None]:
        """Read the encoder of the work axis, where it is time: at the start and then every period."""
        if self.time < gauge.until:
            return
        if gauge.stalled:
            raise self._standstill("the work axis at standstill for one second by its encoder")
        sensor = yield from self._encoders()
        rate = self.circumstances.rate
        turns = abs(sensor.speed(self._feed_axis())) / TURN
        period = max(1, round(FEED_PERIOD * rate))
        gauge.read(turns, (round(self.time * rate) + period) / rate)

    def _standstill(self, found: str) -> AlarmError:
        return alarm("HT9007", found, self._span, valid="a spindle that turns")

    def _feed_axis(self) -> int:
        """The work axis, whose turns count for G99."""
        gear = self.coupling.gear
        if gear:
            return gear.slave if gear.kind is SyncKind.HOBBING else gear.master
        if self.machine.work_spindle is None:
            raise alarm("HT9005", "no work spindle in parameter 9001 for a feed per revolution", self._span)
        return self.machine.work_spindle

    def _driven_axis(self) -> int:
        """The axis whose speed S commands."""
        gear = self.coupling.gear
        return gear.master if gear else self._feed_axis()


@dataclass(slots=True, kw_only=True)
class _OnWay:
    """A path that is being travelled."""

    path: AnyPath
    feed: Feed | None
    manner: Manner
    position: float = 0.0
    speed: float = 0.0
    gauge: Gauge = field(default_factory=Gauge)
    touch: Touch | None = None


def _plan(on_way: _OnWay, wanted: float) -> list[Phase]:
    """The way to the end of the path, or to standstill on it where no speed is wanted; none at standstill."""
    position, speed, rate = on_way.position, on_way.speed, on_way.path.acceleration
    left = on_way.path.end - position
    if wanted > NO_SPEED:
        return trapezoid(left, speed=wanted, acceleration=rate, start_speed=speed, start=position)
    if speed == 0.0:
        return []
    if speed * speed >= 2.0 * rate * left:
        return trapezoid(left, speed=speed, acceleration=rate, start_speed=speed, start=position)
    return [Phase(speed / rate, position, speed, -rate)]
