"""The machine in MuJoCo: servo drives on rigid bodies, one control period after the other."""

# pyright: reportAttributeAccessIssue=false

import math
from dataclasses import dataclass

import mujoco  # its bindings are compiled and carry no types
import numpy as np

from controller.clock import Chunk, Feedback, Floats, Load, MachineAlarm, Watch, WatchKind
from twin.machine.assembly import Assembly
from twin.machine.following import follow, require_chunk
from twin.machine.servo import Servo, tune
from twin.machine.stability import require_stable
from twin.machine.watching import MachineError, Watcher, speed_reached

SI_PER_MM = 1e-3
SI_PER_DEG = math.pi / 180.0


@dataclass(frozen=True, slots=True, kw_only=True)
class _Axis:
    """One axis: its servo, where MuJoCo keeps its state, and its widths in SI."""

    servo: Servo
    motor: int
    qpos: int
    dof: int
    rotary: bool
    unit: float
    """[m/mm | rad/deg]"""
    in_position: float
    error_limit: float


class MujocoMachine:
    """Drives an assembly; power-on with every axis at machine zero and at rest."""

    def __init__(self, assembly: Assembly) -> None:
        """Tune the drives to the inertia as mounted. Raises InputError where they would be unstable."""
        spec, model = assembly.spec, assembly.model
        drives = [spec.drives[name] for name in assembly.joints]
        inertia = assembly.inertia()
        gains = [tune(d, float(i)) for d, i in zip(drives, inertia.diagonal(), strict=True)]
        require_stable(assembly.joints, inertia, gains, spec)
        self.assembly = assembly
        self.data = mujoco.MjData(model)
        """the physical state, for views; changing it changes the machine"""
        self._axes: list[_Axis] = []
        for name, drive, gain in zip(assembly.joints, drives, gains, strict=True):
            joint = model.joint(name)
            rotary = joint.type[0] == mujoco.mjtJoint.mjJNT_HINGE
            unit = SI_PER_DEG if rotary else SI_PER_MM
            self._axes.append(
                _Axis(
                    servo=Servo(gain, spec.control_period_s),
                    motor=model.actuator(name).id,
                    qpos=int(joint.qposadr[0]),
                    dof=int(joint.dofadr[0]),
                    rotary=rotary,
                    unit=unit,
                    in_position=drive.in_position * unit,
                    error_limit=drive.error_limit * unit,
                )
            )
        self._units = np.array([axis.unit for axis in self._axes])
        self._qpos = [axis.qpos for axis in self._axes]
        self._watcher = Watcher()
        self._tick = 0

    def advance(self, chunk: Chunk, load: Load | None = None) -> Feedback:
        """Move along the chunk; stop early at an alarm, or where its watch is fulfilled or times out.

        `load(first_tick, ticks)` gives (ticks, axes) forces on the axes in system order [N, N m], positive
        in the axis's positive sense. Raises MachineError where the physics breaks down.
        """
        require_chunk(chunk, len(self._axes), self._tick)
        watch = self._watcher.begin(chunk.watch)
        limit = chunk.ticks if watch is None else min(chunk.ticks, self._watcher.remaining)
        forces = None if load is None or limit == 0 else self._forces(load, limit)
        setpoint, actual, reached = self._run(chunk, limit, watch, forces)
        ticks = len(actual)
        if not np.isfinite(actual).all() or any(w.number for w in self.data.warning):
            raise MachineError(
                f"the machine's motion broke down between ticks {self._tick} and {self._tick + ticks}",
                remedy="look for setpoints or loads beyond what the drives can do",
            )
        self._tick += ticks
        signals = self._watcher.end(ticks, reached=reached)
        return Feedback(ticks=ticks, setpoint=setpoint, actual=actual, alarms=self._alarms(), signals=signals)

    def rest(self, ticks: int) -> None:
        """Let `ticks` pass in which nothing moves: settled drives hold their axes where they are."""
        self._tick += ticks

    def _forces(self, load: Load, ticks: int) -> Floats:
        forces = load(self._tick, ticks)
        if forces.shape != (ticks, len(self._axes)):
            raise ValueError(f"load: expected ({ticks}, {len(self._axes)}), got {forces.shape}")
        if not np.isfinite(forces).all():
            raise ValueError(f"load: not finite between ticks {self._tick} and {self._tick + ticks}")
        return forces

    def _run(
        self, chunk: Chunk, limit: int, watch: Watch | None, forces: Floats | None
    ) -> tuple[Floats, Floats, bool]:
        """Setpoints as followed, actual positions, and whether the watch was fulfilled at the last tick.

        Plain floats in one loop: on arrays this short numpy would cost more than the physics.
        """
        model, data, axes = self.assembly.model, self.data, self._axes
        substeps = self.assembly.spec.substeps
        qpos, qvel, ctrl, applied = data.qpos, data.qvel, data.ctrl, data.qfrc_applied
        hot = [(k, a.motor, a.qpos, a.dof, a.servo, a.error_limit) for k, a in enumerate(axes)]
        couplings = [(c, axes[c.slave], axes[c.master]) for c in chunk.couplings]
        dofs = [a.dof for a in axes]
        setpoint = chunk.setpoint[:limit].copy()
        record: list[list[float]] = []
        reached = False
        applied[:] = 0.0
        q = qpos.tolist()
        for k, target in enumerate((setpoint * self._units).tolist()):
            v = qvel.tolist()
            for c, slave, _ in couplings:
                target[c.slave] = slave.servo.extrapolated()
            for axis, motor, at, dof, servo, _ in hot:
                ctrl[motor] = servo.force(target[axis], q[at], v[dof])
            if forces is not None:
                applied[dofs] = forces[k]
            mujoco.mj_step(model, data, substeps)
            q = qpos.tolist()
            record.append(q)
            for c, slave, master in couplings:
                followed = follow(c, float(chunk.setpoint[k, c.slave]), q[master.qpos] / master.unit)
                setpoint[k, c.slave] = followed
                slave.servo.reference = followed * slave.unit
            excess = False
            for _, _, at, _, servo, error_limit in hot:
                if abs(servo.reference - q[at]) > error_limit:
                    excess = True
            reached = watch is not None and self._holds(watch, q)
            if excess or reached:
                break
        ticks = len(record)
        actual = np.array(record).reshape(ticks, model.nq)[:, self._qpos] / self._units
        return setpoint[:ticks], actual, reached

    def _holds(self, watch: Watch, q: list[float]) -> bool:
        """Whether the watched axes (`latch_axes`, none named = all) fulfil the condition after this tick."""
        axes = [self._axes[k] for k in watch.latch_axes] or self._axes
        if watch.kind is WatchKind.IN_POSITION:
            return all(abs(a.servo.reference - q[a.qpos]) <= a.in_position for a in axes)
        period, v = self.assembly.spec.control_period_s, self.data.qvel
        return all(speed_reached(a.servo.speed(period), v[a.dof]) for a in axes if a.rotary)

    def _alarms(self) -> tuple[MachineAlarm, ...]:
        """Axes whose following error now exceeds its limit."""
        alarms: list[MachineAlarm] = []
        for k, (name, axis) in enumerate(zip(self.assembly.joints, self._axes, strict=True)):
            error = axis.servo.reference - float(self.data.qpos[axis.qpos])
            if abs(error) > axis.error_limit:
                moving = axis.servo.reference != axis.servo.previous
                unit = "deg" if axis.rotary else "mm"
                alarms.append(
                    MachineAlarm(
                        number="SV0411" if moving else "SV0410",
                        axis=k,
                        found=f"{name}: following error {error / axis.unit:.4g} {unit}, "
                        f"limit {axis.error_limit / axis.unit:g} {unit}",
                    )
                )
        return tuple(alarms)
