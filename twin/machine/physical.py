"""The machine in MuJoCo: drives on rigid bodies, one control period after the other."""

# pyright: reportAttributeAccessIssue=false

from collections.abc import Callable
from dataclasses import dataclass

import mujoco  # its bindings are compiled and carry no types
import numpy as np

from controller.clock import Chunk, Feedback, Floats, Follow, Load, MachineAlarm, Watch, WatchKind
from twin.errors import InputError
from twin.machine.assembly import Assembly
from twin.machine.backlash import Backlash
from twin.machine.drive import AxisDrive, DriveKind
from twin.machine.encoder import encoder
from twin.machine.following import follow, require_chunk
from twin.machine.induction import Induction, steepest
from twin.machine.loops import Loops
from twin.machine.pressing import Pressing
from twin.machine.servo import Gains, Servo, tune
from twin.machine.stability import require_stable
from twin.machine.stylus import Stylus
from twin.machine.watching import MachineError, Watcher, require_probe, speed_reached


@dataclass(frozen=True, slots=True, kw_only=True)
class _Axis:
    """One axis: its drive at work, and where MuJoCo keeps its state."""

    drive: AxisDrive
    loop: Servo | Induction
    read: Callable[[float], float]
    """encoder: motor-side position to reading, both referred to the axis"""
    backlash: Backlash
    motor: int
    qpos: int
    dof: int
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
        spec, model = assembly.spec, assembly.model
        drives, inertia = assembly.drives(), assembly.inertia()
        gains = [tune(d, float(i)) for d, i in zip(drives, inertia.diagonal(), strict=True)]
        _require_steady(assembly, drives, inertia, gains)
        period = spec.control_period_s
        self.assembly = assembly
        self.data = mujoco.MjData(model)
        """the physical state, for views; changing it changes the machine"""
        self._axes: list[_Axis] = []
        for name, drive, gain in zip(assembly.joints, drives, gains, strict=True):
            joint = model.joint(name)
            servo = drive.drive.kind is DriveKind.SERVO
            self._axes.append(
                _Axis(
                    drive=drive,
                    loop=Servo(gain, period) if servo else Induction(drive, period),
                    read=encoder(drive),
                    backlash=Backlash(drive.backlash, drive.drive.coulomb_friction),
                    motor=model.actuator(name).id,
                    qpos=int(joint.qposadr[0]),
                    dof=int(joint.dofadr[0]),
                    rotary=joint.type[0] == mujoco.mjtJoint.mjJNT_HINGE,
                )
            )
        self._units = np.array([d.unit for d in drives])
        self._qpos = [axis.qpos for axis in self._axes]
        self._overload = [max(1, round(d.drive.overload_time_s / period)) for d in drives]
        self._reading = [0.0] * len(self._axes)
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
        if not np.isfinite(run.motor).all() or self.data.warning.number.any():
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

    def _run(self, chunk: Chunk, limit: int, watch: Watch | None, pressing: Pressing | None) -> _Stretch:
        """Step through the chunk, at most `limit` ticks, to where it has to end.

        Plain floats in one loop: on arrays this short numpy would cost more than the physics.
        """
        model, data, axes = self.assembly.model, self.data, self._axes
        substeps = self.assembly.spec.substeps
        qpos, qvel, ctrl, applied = data.qpos, data.qvel, data.ctrl, data.qfrc_applied
        servos = [
            (k, a.motor, a.loop, a.drive.error_limit, self._overload[k])
            for k, a in enumerate(axes)
            if isinstance(a.loop, Servo)
        ]
        inductions = [
            (k, a.motor, a.dof, a.loop) for k, a in enumerate(axes) if isinstance(a.loop, Induction)
        ]
        readers = [(a.read, a.qpos) for a in axes]
        couplings = [(c, *self._follower(c), axes[c.master].drive.unit) for c in chunk.couplings]
        dofs = [a.dof for a in axes]
        setpoint = chunk.setpoint[:limit].copy()
        positions: list[list[float]] = []
        readings: list[list[float]] = []
        reached, latch = False, None
        stylus = self._stylus
        applied[:] = 0.0
        m = self._reading
        for k, target in enumerate((setpoint * self._units).tolist()):
            for c, slave, _, _ in couplings:
                target[c.slave] = slave.extrapolated()
            for axis, motor, servo, _, _ in servos:
                ctrl[motor] = servo.force(target[axis], m[axis])
            for axis, motor, dof, induction in inductions:
                ctrl[motor] = induction.force(target[axis], float(qvel[dof]))
            if pressing is not None:
                spindle = axes[pressing.spindle]
                applied[dofs] = pressing.feel(k, float(qpos[spindle.qpos]), float(qvel[spindle.dof]))
            if stylus is not None:
                stylus.prepare(k, data)
            mujoco.mj_step(model, data, substeps)
            q = qpos.tolist()
            before = m
            m = [read(q[at]) for read, at in readers]
            positions.append(q)
            readings.append(m)
            for c, slave, unit, master_unit in couplings:
                followed = follow(c, float(chunk.setpoint[k, c.slave]), m[c.master] / master_unit)
                setpoint[k, c.slave] = followed
                slave.reference = followed * unit
            alarm = False
            for axis, _, servo, error_limit, overload in servos:
                if abs(servo.reference - m[axis]) > error_limit or servo.periods_at_limit >= overload:
                    alarm = True
            if stylus is not None:
                share = stylus.follow(data)
                if share is not None:
                    latch = np.array(before) + share * (np.array(m) - before)
                alarm = alarm or stylus.alarm is not None
            reached = latch is not None or (watch is not None and self._holds(watch, m))
            if alarm or reached:
                break
        self._reading = m
        shape = len(positions), len(axes)
        motor_side = np.array(positions).reshape(len(positions), model.nq)[:, self._qpos]
        return _Stretch(
            setpoint=setpoint[: len(positions)],
            motor=motor_side,
            measured=np.array(readings).reshape(shape),
            reached=reached,
            latch=latch,
        )

    def _follower(self, coupling: Follow) -> tuple[Servo, float]:
        """Loop and unit of a coupling's slave. Raises MachineError where it is no servo."""
        axis = self._axes[coupling.slave]
        if not isinstance(axis.loop, Servo):
            raise MachineError(
                f"{self.assembly.joints[coupling.slave]} is the slave of the gear box, and its motor has no "
                "position loop",
                remedy='kind = "servo" for this drive',
            )
        return axis.loop, axis.drive.unit

    def _load_side(self, motor: Floats, forces: Floats | None) -> Floats:
        """(ticks, axes) positions of the load behind the motors' [m | rad]."""
        columns = [
            axis.backlash.follow(motor[:, k], None if forces is None else forces[:, k])
            for k, axis in enumerate(self._axes)
        ]
        return np.column_stack(columns)

    def _holds(self, watch: Watch, m: list[float]) -> bool:
        """Whether the watched axes (`latch_axes`, none named = all) fulfil the condition after this tick.

        A spindle without a position loop is always in position. Touches are the stylus's affair.
        """
        if watch.kind is WatchKind.SKIP:
            return False
        watched = watch.latch_axes or range(len(self._axes))
        if watch.kind is WatchKind.IN_POSITION:
            return all(
                abs(a.loop.reference - m[k]) <= a.drive.in_position
                for k, a in ((k, self._axes[k]) for k in watched)
                if isinstance(a.loop, Servo)
            )
        period, v = self.assembly.spec.control_period_s, self.data.qvel
        axes = [self._axes[k] for k in watched]
        return all(speed_reached(a.loop.speed(period), v[a.dof]) for a in axes if a.rotary)

    def _alarms(self) -> tuple[MachineAlarm, ...]:
        """Axes whose following error exceeds its limit now, or whose motor has stood too long at its own."""
        alarms: list[MachineAlarm] = []
        if self._stylus is not None and self._stylus.alarm is not None:
            alarms.append(self._stylus.alarm)
        for k, (name, axis) in enumerate(zip(self.assembly.joints, self._axes, strict=True)):
            loop, drive = axis.loop, axis.drive
            if not isinstance(loop, Servo):
                continue
            error = loop.reference - self._reading[k]
            if abs(error) > drive.error_limit:
                moving = loop.reference != loop.previous
                unit = "deg" if axis.rotary else "mm"
                number = "SV0411" if moving else "SV0410"
                found = (
                    f"following error {error / drive.unit:.4g} {unit}, "
                    f"limit {drive.error_limit / drive.unit:g} {unit}"
                )
            elif loop.periods_at_limit >= self._overload[k]:
                number = "SV0436"
                found = (
                    f"motor at its limit of {drive.drive.torque_limit:g} N m for "
                    f"{drive.drive.overload_time_s:g} s"
                )
            else:
                continue
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
