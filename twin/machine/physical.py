"""The machine in MuJoCo: drives on rigid bodies, one control period after the other."""

# pyright: reportAttributeAccessIssue=false

import copy
from dataclasses import dataclass, replace

import mujoco  # its bindings are compiled and carry no types
import numpy as np

from controller.clock import Chunk, Feedback, Floats, Follow, Load, MachineAlarm, Watch, WatchKind
from twin.errors import InputError
from twin.machine.assembly import Assembly
from twin.machine.backlash import Backlash
from twin.machine.bare import stop_the_clock
from twin.machine.drive import AxisDrive, DriveKind
from twin.machine.following import follow, require_chunk
from twin.machine.induction import Induction, steepest
from twin.machine.loops import Loops
from twin.machine.pressing import Pressing
from twin.machine.servo import Gains, Servo, tune
from twin.machine.stability import require_stable
from twin.machine.stylus import Stylus
from twin.machine.terminals import Terminals, terminals, view
from twin.machine.watching import MachineError, Watcher, require_probe, speed_reached


@dataclass(frozen=True, slots=True, kw_only=True)
class _Axis:
    """One axis: its drive at work, and where it is wired to MuJoCo."""

    drive: AxisDrive
    loop: Servo | Induction
    backlash: Backlash
    at: Terminals
    rotary: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class _Stretch:
    """What the loop has made of a chunk, n ticks of it."""

    setpoint: Floats
    """(n, axes) as followed [mm | deg]"""
    motor: Floats
    """(n, axes) motor-side positions [m | rad]"""
    measured: Floats
    """(n, axes) encoder readings [m | rad]"""
    reached: bool
    """whether the watch was fulfilled at the last tick"""
    latch: Floats | None
    """(axes,) readings at the touch of the probe [m | rad]"""


class MujocoMachine:
    """Drives an assembly; power-on with every axis at machine zero and at rest."""

    def __init__(self, assembly: Assembly) -> None:
        """Tune the drives to the inertia as mounted. Raises InputError where they would be unstable."""
        spec, model = assembly.spec, assembly.joints_alone
        drives, inertia = assembly.drives(), assembly.inertia()
        gains = [tune(d, float(i)) for d, i in zip(drives, inertia.diagonal(), strict=True)]
        _require_steady(assembly, drives, inertia, gains)
        period = spec.control_period_s
        stop_the_clock()
        self.assembly = assembly
        self.data = mujoco.MjData(model)
        """the physical state of `assembly.joints_alone`, for views; changing it changes the machine"""
        self._reading = np.zeros(len(drives))
        self._tripped: list[Servo] = []
        self._axes: list[_Axis] = []
        for k, (name, drive, gain) in enumerate(zip(assembly.joints, drives, gains, strict=True)):
            at = terminals(model, self.data, name, view(self._reading, k))
            servo = drive.drive.kind is DriveKind.SERVO
            self._axes.append(
                _Axis(
                    drive=drive,
                    loop=Servo(drive, gain, period, at, trip=self._tripped.append)
                    if servo
                    else Induction(drive, period, at),
                    backlash=Backlash(drive.backlash, drive.drive.coulomb_friction),
                    at=at,
                    rotary=model.joint(name).type[0] == mujoco.mjtJoint.mjJNT_HINGE,
                )
            )
        self._units = np.array([d.unit for d in drives])
        self._played = [k for k, drive in enumerate(drives) if drive.backlash]
        self._qpos = [int(model.joint(name).qposadr[0]) for name in assembly.joints]
        self._warnings = self.data.warning.number
        self._watcher = Watcher()
        self._stylus = None
        if assembly.stylus is not None:
            self._stylus = Stylus(model, assembly.stylus, "work_spindle", period)
        self._tick = 0

    def advance(self, chunk: Chunk, load: Load | None = None) -> Feedback:
        """Move along the chunk; stop early at an alarm, or where its watch is fulfilled or times out.

        `load(first_tick, ticks)` gives (ticks, axes) forces on the axes in system order [N, N m], positive
        in the axis's positive sense; a `PhasedLoad` those of its spindle's angle. Raises MachineError
        where the physics breaks down.
        """
        require_chunk(chunk, len(self._axes), self._tick)
        watch = self._watcher.begin(chunk.watch)
        if self._stylus is not None:
            self._stylus.begin(chunk)
        else:
            require_probe(chunk, None)
        limit = chunk.ticks if watch is None else min(chunk.ticks, self._watcher.remaining)
        pressing = None if load is None or limit == 0 else Pressing(load, self._tick, limit, len(self._axes))
        run = self._run(chunk, limit, watch, pressing)
        ticks = len(run.motor)
        if not np.isfinite(run.motor).all() or self._warnings.any():
            raise MachineError(
                f"the machine's motion broke down between ticks {self._tick} and {self._tick + ticks}",
                remedy="look for setpoints or loads beyond what the drives can do",
            )
        self._tick += ticks
        signals = self._watcher.end(ticks, reached=run.reached)
        return Feedback(
            ticks=ticks,
            setpoint=run.setpoint,
            actual=self._load_side(run.motor, np.array(pressing.felt) if pressing else None) / self._units,
            measured=run.measured / self._units,
            latch=None if run.latch is None else run.latch / self._units,
            alarms=self._alarms(),
            signals=signals,
        )

    def rest(self, ticks: int) -> None:
        """Let `ticks` pass in which nothing moves: settled drives hold their axes where they are."""
        self._tick += ticks

    def __deepcopy__(self, memo: dict[int, object]) -> "MujocoMachine":
        """Another machine in the same state; what was compiled is common to both."""
        other = copy.copy(self)
        memo[id(self)], memo[id(self.assembly.joints_alone)] = other, self.assembly.joints_alone
        other.data = copy.copy(self.data)
        other._reading = self._reading.copy()
        other._tripped = []
        other._warnings = other.data.warning.number
        other._watcher, other._stylus = copy.deepcopy((self._watcher, self._stylus), memo)
        other._axes = []
        for k, (name, axis) in enumerate(zip(self.assembly.joints, self._axes, strict=True)):
            at = terminals(self.assembly.joints_alone, other.data, name, view(other._reading, k))
            loop = axis.loop
            moved = loop.moved_to(at, other._tripped.append) if isinstance(loop, Servo) else loop.moved_to(at)
            other._axes.append(replace(axis, at=at, loop=moved, backlash=copy.copy(axis.backlash)))
        return other

    def _run(self, chunk: Chunk, limit: int, watch: Watch | None, pressing: Pressing | None) -> _Stretch:
        """Step through the chunk, at most `limit` ticks, to where it has to end.

        Plain floats in one loop: on arrays this short numpy would cost more than the physics.
        """
        model, data, tripped = self.assembly.joints_alone, self.data, self._tripped
        stylus = self._stylus if self._stylus is not None and self._stylus.busy else None
        step, substeps = mujoco.mj_step, self.assembly.spec.substeps
        gears = [self._gear(c) for c in chunk.couplings]
        slaves = [slave for _, slave, _, _ in gears]
        forces = [a.loop.force for a in self._axes]
        observers = [a.loop.observe for a in self._axes if a.loop not in slaves]
        qpos, reading = data.qpos.data, self._reading.data
        # rows of what was, as MuJoCo and the encoders hold it
        positions, readings = bytearray(), bytearray()
        setpoint = chunk.setpoint[:limit].copy()
        reached, latch = False, None
        before = self._reading
        tripped.clear()
        data.qfrc_applied[:] = 0.0
        for k, target in enumerate((setpoint * self._units).tolist()):
            for c, slave, _, _ in gears:
                target[c.slave] = slave.extrapolated
            for force, goal in zip(forces, target):  # noqa: B905 - both as long as the axes
                force(goal)
            if pressing is not None:
                self._press(pressing, k)
            if stylus is not None:
                before = self._reading.copy()
                stylus.prepare(k, data)
            step(model, data, substeps)
            for observe in observers:
                observe()
            for c, slave, unit, master in gears:
                followed = follow(
                    c, float(chunk.setpoint[k, c.slave]), master.at.reading[0] / master.drive.unit
                )
                setpoint[k, c.slave] = followed
                slave.follow(followed * unit)
            positions += qpos
            readings += reading
            if stylus is not None:
                if (share := stylus.follow(data)) is not None:
                    latch = before + share * (self._reading - before)
                if stylus.alarm is not None:
                    break
            reached = latch is not None or (watch is not None and self._holds(watch))
            if reached or tripped:
                break
        motor_side = np.frombuffer(positions).reshape(-1, model.nq)[:, self._qpos]
        return _Stretch(
            setpoint=setpoint[: len(motor_side)],
            motor=motor_side,
            measured=np.frombuffer(readings).reshape(-1, len(self._axes)),
            reached=reached,
            latch=latch,
        )

    def _press(self, pressing: Pressing, row: int) -> None:
        """Put the load of a tick on the axes."""
        spindle = self._axes[pressing.spindle].at
        pushes = pressing.feel(row, spindle.position[0], spindle.speed[0])
        for axis, push in zip(self._axes, pushes, strict=True):
            axis.at.load[0] = push

    def _gear(self, coupling: Follow) -> tuple[Follow, Servo, float, _Axis]:
        """A coupling with its slave's loop and unit, and its master. Raises MachineError for a slave that is
        no servo."""
        axis = self._axes[coupling.slave]
        if not isinstance(axis.loop, Servo):
            raise MachineError(
                f"{self.assembly.joints[coupling.slave]} is the slave of the gear box, and its motor has no "
                "position loop",
                remedy='kind = "servo" for this drive',
            )
        return coupling, axis.loop, axis.drive.unit, self._axes[coupling.master]

    def _load_side(self, motor: Floats, forces: Floats | None) -> Floats:
        """(ticks, axes) positions of the load behind the motors' [m | rad]."""
        load = motor.copy() if self._played else motor
        for k in self._played:
            load[:, k] = self._axes[k].backlash.follow(motor[:, k], None if forces is None else forces[:, k])
        return load

    def _holds(self, watch: Watch) -> bool:
        """Whether the watched axes (`latch_axes`, none named = all) fulfil the condition after this tick.

        A spindle without a position loop is always in position. Touches are the stylus's affair.
        """
        if watch.kind is WatchKind.SKIP:
            return False
        axes = [self._axes[k] for k in watch.latch_axes or range(len(self._axes))]
        if watch.kind is WatchKind.IN_POSITION:
            return all(abs(a.loop.lag) <= a.drive.in_position for a in axes if isinstance(a.loop, Servo))
        period = self.assembly.spec.control_period_s
        return all(speed_reached(a.loop.speed(period), a.at.speed[0]) for a in axes if a.rotary)

    def _alarms(self) -> tuple[MachineAlarm, ...]:
        """Of the probe, and of axes whose following error exceeds its limit now, or whose motor has stood too
        long at its own."""
        alarms: list[MachineAlarm] = []
        if self._stylus is not None and self._stylus.alarm is not None:
            alarms.append(self._stylus.alarm)
        if not self._tripped:
            return tuple(alarms)
        for k, (name, axis) in enumerate(zip(self.assembly.joints, self._axes, strict=True)):
            loop, drive = axis.loop, axis.drive
            if not isinstance(loop, Servo) or loop not in self._tripped:
                continue
            if abs(loop.lag) > drive.error_limit:
                unit = "deg" if axis.rotary else "mm"
                number = "SV0411" if loop.moving else "SV0410"
                found = (
                    f"following error {loop.lag / drive.unit:.4g} {unit}, "
                    f"limit {drive.error_limit / drive.unit:g} {unit}"
                )
            else:
                number = "SV0436"
                found = (
                    f"motor at its limit of {drive.drive.torque_limit:g} N m for "
                    f"{drive.drive.overload_time_s:g} s"
                )
            alarms.append(MachineAlarm(number=number, axis=k, found=f"{name}: {found}"))
        return tuple(alarms)


def _require_steady(
    assembly: Assembly, drives: tuple[AxisDrive, ...], inertia: Floats, gains: list[Gains]
) -> None:
    """Raise InputError, with the limit, where the sampled drives would not be stable."""
    spec = assembly.spec
    kinds = [d.drive.kind is DriveKind.SERVO for d in drives]
    servos = np.flatnonzero(kinds)
    loops = Loops(
        mass=inertia[np.ix_(servos, servos)],
        viscous=np.array([drives[k].drive.viscous_friction for k in servos]),
        gains=[gains[k] for k in servos],
        period_s=spec.control_period_s,
        substeps=spec.substeps,
    )
    require_stable([assembly.joints[k] for k in servos], loops, spec)
    for k in np.flatnonzero(~np.array(kinds)):
        # held for a period, the steepest slope of torque over speed must not overshoot standstill
        rate = steepest(drives[k]) / inertia[k, k]
        if rate * spec.control_period_s >= 2.0:
            name = assembly.joints[k]
            least = drives[k].drive.breakdown_slip * rate * spec.control_period_s / 2.0
            raise InputError(
                f"drives.{name}: breakdown_slip {drives[k].drive.breakdown_slip:g} 1/min makes the motor so "
                "stiff that it is unstable at this control period",
                place=spec.place_of(("drives", name, "breakdown_slip")),
                remedy=f"stable above {least:.4g} 1/min",
            )
