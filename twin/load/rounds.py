"""A run under its own cutting forces: window after window, round after round.

A window and its forces belong together when the forces that its chips cause move nothing any more. In each
round the machine goes through the window from where the last one has left it, under forces that are tried;
the metal that it takes away so gives the forces of the next round. A window that eight rounds do not settle
is gone through in shorter ones; the shortest that they do not settle is an unstable cut: what is pushed away
comes back as more force.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from controller.span import Span
from controller.tables.alarms import Alarm
from twin.course import Course, Tape
from twin.cutters.cutter import Cutter
from twin.cutting.field import DepthField
from twin.cutting.motion import CutterMotion
from twin.job.schema import Job
from twin.load.agreement import Agreement
from twin.load.change import bound_um, change_um, dominant_hz
from twin.load.forces import Clock, CuttingLoad, cutting_load, joined, no_load, summed
from twin.load.material import Material, material_of
from twin.load.removal import cut_off
from twin.load.stock import Stock
from twin.load.windows import SHORTEST, Window, windows
from twin.machine.pressing import REACH
from twin.session import Session, motions_on, session_of, ticks_of
from twin.setup import Ready

Floats = NDArray[np.float64]
Tools = list[tuple[Cutter, CutterMotion]]

MOST_ROUNDS = 8
SETTLED_UM = 0.1
"""by how much the last round may still have moved the part's surface"""


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadedRun:
    """A run under its own cutting forces."""

    session: Session
    load: CuttingLoad
    """that acted on it"""
    material: Material
    windows: int
    """that the run was made in"""
    rounds: int
    """that the hardest of them has taken"""
    moved_um: tuple[float, ...]
    """by how much at most each of its rounds but the first moved the part's surface"""
    frequency_hz: float | None
    """that its last round changed most; None where all have settled"""
    resolution_mm: float
    """distance of the rays on which metal was counted"""
    tick_s: float

    @property
    def removed_mm3(self) -> float:
        """Metal that the forces belong to."""
        return float(self.load.removed_mm3.sum())

    @property
    def energy_j(self) -> float:
        """Work of cutting."""
        return float(self.load.power_w.sum()) * self.tick_s

    @property
    def mean_power_w(self) -> float:
        """While metal is removed."""
        return float(self.load.power_w.mean()) if len(self.load.cell) else 0.0

    @property
    def settled(self) -> bool:
        """Whether forces and motion belong together."""
        return self.frequency_hz is None


@dataclass(frozen=True, slots=True, kw_only=True)
class _State:
    """Where a run stands whose past is final."""

    course: Course
    stock: Stock
    cut_s: float
    """passes up to this time have cut the stock"""
    past: tuple[CuttingLoad, ...]
    """what acted in each of the windows so far, by whole ticks"""
    acted: CuttingLoad
    """the last of it, up to the course's tick"""
    tail: CuttingLoad
    """of passes that have cut, from that tick on"""
    expected: CuttingLoad
    """of all passes from that tick on, if things go on as they have"""
    window: Window | None = None
    """that has led here"""

    def load(self) -> CuttingLoad:
        """All that has acted so far."""
        return joined(self.past) if self.past else self.acted.whole()


@dataclass(frozen=True, slots=True, kw_only=True)
class _Result:
    """What the rounds of a window have come to."""

    state: _State
    rounds: int
    moved_um: tuple[float, ...]
    frequency_hz: float | None = None
    """None where it has settled"""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Taken:
    """The metal of one round."""

    stock: Stock
    """that the window leaves"""
    cut_s: float
    tail: CuttingLoad
    """of the passes up to the window's end, and of earlier ones"""
    caused: CuttingLoad
    """of all passes that were looked at"""


def run_under_load(
    job: Job,
    ready: Ready,
    course: Course,
    *,
    outline: Course,
    shortest: int = SHORTEST,
    tell: Callable[[str], None] = lambda _text: None,
) -> LoadedRun:
    """Run until forces and motion belong together everywhere, or up to a window that does not settle: the
    session ends there, with the alarm HT9040.

    `course` is the program before its first tick, `outline` the same on ideal axes, which says where windows
    begin; they are `shortest` ticks long or longer. Raises InputError for a material without figures.
    """
    rounds = _Rounds(job, ready)
    outline.go()
    plan = outline.tape()
    at = plan.actual[:, ready.tool_column], ticks_of(plan, rounds.tick_s)
    ahead = windows(*at, shortest=shortest)
    tell(f"cutting forces, window after window: {len(ahead)}")
    state = rounds.begun(course)
    results: list[_Result] = []
    hertz, tried = None, None
    while ahead and not state.course.finished:
        window = ahead.pop(0)
        if window.until is not None and window.known <= state.course.tick:
            continue  # idle time has led beyond it
        result = rounds.settled(state, window)
        if result.frequency_hz is not None:
            finer = _within(windows(*at, shortest=0), state.course.tick, window)
            # the longest window tells the frequency best
            hertz = hertz or result.frequency_hz
            if finer:
                ahead = [*finer, window, *ahead]
                tried = result.state.acted
                state = replace(state, expected=tried)
                continue
            results.append(replace(result, frequency_hz=hertz))
            state = result.state
            break
        results.append(result)
        state, hertz = result.state, None
        if tried is not None:
            # the longer window's last round knows the rest of it better than what went before
            rest = tried.since(state.course.tick)
            state, tried = (replace(state, expected=rest), tried) if len(rest.cell) else (state, None)
    load = state.load()
    session = session_of(state.course, ready, load if len(load.cell) else None)
    hardest = max(results, key=lambda one: (one.frequency_hz is not None, one.rounds))
    if hardest.frequency_hz is not None:
        session = replace(session, alarms=(*session.alarms, _unstable(hardest, session)))
    return LoadedRun(
        session=session,
        load=load,
        material=rounds.material,
        windows=len(results),
        rounds=hardest.rounds,
        moved_um=hardest.moved_um,
        frequency_hz=hardest.frequency_hz,
        resolution_mm=state.stock.step,
        tick_s=rounds.tick_s,
    )


class _Rounds:
    """One job's rounds."""

    def __init__(self, job: Job, ready: Ready) -> None:
        self.material = material_of(job.work.material, job.physics)
        self.tick_s = ready.spec.control_period_s
        self._physics = job.physics
        self._blank = job.work.blank()
        self._ready = ready
        self._kinematics = ready.tools[0].kinematics

    def begun(self, course: Course) -> _State:
        """The whole blank before the first tick."""
        none = no_load(self._kinematics, self._physics)
        cutters = [tool.cutter for tool in self._ready.tools]
        stock = Stock.of(self._blank, cutters, self._physics.load_resolution_mm)
        return _State(course=course, stock=stock, cut_s=-1.0, past=(), acted=none, tail=none, expected=none)

    def settled(self, state: _State, window: Window) -> _Result:
        """Go through a window round after round."""
        agreement, acted, moved = Agreement(), state.expected, list[float]()
        before: Tools | None = None
        taken: _Taken | None = None
        while True:
            course, mark = self._gone_through(state, window, acted)
            tape = course.tape(state.course.tick - 1)
            motions = self._motions(tape, state.acted.then(acted))
            if before is not None and taken is not None:
                sizes = {"radius": self._blank.radius, "tick_s": self.tick_s}
                change, when = change_um([m for _, m in before], [m for _, m in motions], acted.tick, **sizes)
                moved.append(bound_um(change))
                if moved[-1] < SETTLED_UM:
                    break
                if len(moved) == MOST_ROUNDS - 1:
                    past = (*state.past, acted.whole())
                    end = replace(state, course=course, past=past, acted=acted)
                    hertz = dominant_hz(change, when, self.tick_s)
                    return _Result(
                        state=end, rounds=len(moved) + 1, moved_um=tuple(moved), frequency_hz=hertz
                    )
            taken = self._taken(state, window, course, tape, motions)
            if not len(acted.cell) and not len(taken.caused.cell):
                break
            acted = agreement.after(acted, taken.caused).since(state.course.tick)
            before = motions
        tick = mark.tick
        end = _State(
            course=mark,
            stock=taken.stock,
            cut_s=taken.cut_s,
            past=(*state.past, acted.before(tick).whole()),
            acted=state.acted.then(acted.before(tick)).since(tick - REACH - 1),
            tail=taken.tail.since(tick),
            expected=self._expected(state, window, taken.caused).since(tick),
            window=window,
        )
        return _Result(state=end, rounds=len(moved) + 1, moved_um=tuple(moved))

    def _gone_through(self, state: _State, window: Window, acted: CuttingLoad) -> tuple[Course, Course]:
        """The course at the end of a window, and where the window's forces are final."""
        course, load = state.course.fork(), state.acted.then(acted)
        pressed = load if len(load.cell) else None
        course.go(until=window.known, load=pressed)
        mark = course.fork()
        course.go(until=window.end, load=pressed)
        return course, course if course.finished else mark

    def _motions(self, tape: Tape, load: CuttingLoad) -> Tools:
        ticks = ticks_of(tape, self.tick_s)
        deflection = load.on(ticks, tape.actual[:, self._ready.tool_column]).deflection_um(ticks)
        on = motions_on(tape, self._ready, deflection)
        return [(cutter, motion) for _, cutter, motion in on if cutter is not None]

    def _taken(self, state: _State, window: Window, course: Course, tape: Tape, tools: Tools) -> _Taken:
        """The metal that a window's motion takes away, and the forces of that."""
        last = None if course.finished else window.until
        until = math.inf if last is None else (last + 0.5) * self.tick_s
        fields, now, later, times = [], [], [], [np.zeros(0)]
        for cutter, motion in tools:
            field = DepthField(cutter, motion, self._blank.radius, self._blank.z_range)
            at = np.interp(field.passes.at, np.arange(len(motion.time_s)), motion.time_s)
            fields.append(field)
            now.append(np.flatnonzero((at > state.cut_s) & (at <= until)))
            later.append(np.flatnonzero(at > max(until, state.cut_s)))
            times.append(at)
        stock, motions = state.stock.copy(), [motion for _, motion in tools]
        clock = Clock(
            tick_s=self.tick_s,
            tick=ticks_of(tape, self.tick_s),
            tool_angle_deg=tape.actual[:, self._ready.tool_column],
        )
        loads = [state.tail.on(clock.tick, clock.tool_angle_deg)]
        left = stock
        for passes in (now, later):
            metal = cut_off(stock, list(zip(fields, passes, strict=True)), motions)
            loads.append(
                cutting_load(
                    metal,
                    motions,
                    kinematics=self._kinematics,
                    material=self.material,
                    physics=self._physics,
                    clock=clock,
                )
            )
            if passes is now:
                left = stock.copy()
        tail = summed(loads[:2])
        return _Taken(
            stock=left,
            cut_s=until if last is None else _between(np.concatenate(times), until),
            tail=tail,
            caused=summed([tail, loads[2]]),
        )

    def _expected(self, state: _State, window: Window, caused: CuttingLoad) -> CuttingLoad:
        """The same forces in the next window, as far as it is like this one and the one before."""
        last = state.window
        if last is None or last.until is None or window.until is None:
            return no_load(self._kinematics, self._physics)
        ticks = window.until - last.until
        turned = np.interp([window.until, last.until], *caused.angle)
        return caused.later(ticks, round((turned[0] - turned[1]) / 360.0))


def _within(finer: list[Window], tick: int, window: Window) -> list[Window]:
    """Those that end between a tick and the end of a window."""
    last = math.inf if window.until is None else window.until
    return [one for one in finer if one.known > tick and one.until is not None and one.until < last]


def _between(times: Floats, instant: float) -> float:
    """A time near an instant at which no pass is in its middle: the next motion has it a little elsewhere."""
    before, after = times[times <= instant], times[times > instant]
    if not len(before) or not len(after):
        return instant
    return 0.5 * (float(before.max()) + float(after.min()))


def _unstable(result: _Result, session: Session) -> Alarm:
    recording = session.recording
    rounds = ", ".join(f"{one:.3g}" for one in result.moved_um)
    block = recording.blocks[int(recording.block[-1])]
    acted = result.state.acted
    torque = float(np.abs(acted.whole().axes[:, acted.spindle]).max(initial=0.0))
    return Alarm(
        number="HT9040",
        found=f"up to {recording.time_s[-1]:.3f} s the part's surface still moved by "
        f"{result.moved_um[-1]:.3g} µm in round {result.rounds}, most at {result.frequency_hz:.4g} Hz "
        f"(by round: {rounds} µm), with up to {torque:.3g} N m on the tool",
        span=Span(file=block.file, line=block.line),
    )
