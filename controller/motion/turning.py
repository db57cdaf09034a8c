"""Spindles and gear box in time: speeds, overrides, engaging and releasing, and how everything is stopped."""

import math

from controller.commands import Couple, SpindleSpeed, SurfaceSpeed
from controller.interrupts import EmergencyStop
from controller.laws.gearbox import GearBox, SyncKind
from controller.motion.path import NOTHING, AnyPath, Travel
from controller.motion.requests import Steps
from controller.motion.spindles import DEG_PER_S
from controller.motion.travel import Travelling
from controller.tables.alarms import Alarm, alarm
from controller.tables.signals import AxisInput


class Turning(Travelling):
    """Turns spindles and couples them."""

    _threading = False
    """a threading pass is on its way: the spindle override waits"""

    def _turn(self, axis: int, rpm: float) -> None:
        """Ramp a spindle to a programmed speed [rpm]; the master of a gear box as its slave can follow."""
        coupling, spindles = self.coupling, self.spindles
        gear = coupling.gear
        if gear is None or axis != gear.master:
            spindles.turn(axis, rpm, self.time)
            return
        ramp, before = self._ramp(), abs(self.timeline.tracks[axis].speed(self.time))
        ready = spindles.turn(axis, rpm, self.time, ramp, highest=coupling.highest)
        after = abs(self.timeline.tracks[axis].speed(ready))
        coupling.note_peaks(max(before, after), ramp or 0.0)

    def _ramp(self) -> float | None:
        """Acceleration of the master that the slave can follow, beside a path that slows down for it, too."""
        ramp, path, epoch = self.coupling.ramp(), self._underway, self.timeline.coupling
        if ramp is None or path is None or epoch is None:
            return ramp
        shift = abs(self._shift(path))
        return min(ramp, path.acceleration * shift / abs(epoch.gear.ratio)) if shift > NOTHING else ramp

    def _spindle(self, command: SpindleSpeed) -> Steps[None] | None:
        gear, axis = self.coupling.gear, command.axis
        self.references.require_attached(axis, self.machine.axes[axis].letter, self._span)
        if gear is None or axis != gear.master:
            self.spindles.free.add(axis)
            self.spindles.surface = None
        self._turn(command.axis, command.rpm)
        self.note_extents()
        return self._come_to_rest(axis) if command.wait else None

    def _come_to_rest(self, axis: int) -> Steps[None]:
        """Wait for a spindle to stand; out of sync the display shows where (in sync G80 counts it)."""
        yield from self._ready(axis)
        if self.coupling.gear is None:
            self.registers.orient(axis, self.timeline.positions(self.time)[axis])
            self.note_extents()

    def _surface_speed(self, command: SurfaceSpeed) -> None:
        axis = command.axis
        self.references.require_attached(axis, self.machine.axes[axis].letter, self._span)
        self.spindles.surface = command
        self.spindles.free.add(axis)
        self.spindles.adapt(self.registers.absolute[command.radial], self.time)

    def _override_spindles(self) -> None:
        """The override of the panel acts on whatever turns; of a gear box on the master alone."""
        self.spindles.override = self.panel.spindle_override
        for axis, rpm in list(self.spindles.commanded.items()):
            if rpm:
                self._turn(axis, rpm)

    def _stop_spindles(self, columns: list[int]) -> Steps[None]:
        """Whatever turns of these axes comes to standstill, and is waited for."""
        self.spindles.surface = None
        turning = [k for k in columns if self.spindles.driven(k, self.time)]
        for axis in turning:
            self._turn(axis, 0.0)
        yield from self._wait(max((self.spindles.ready(k, self.time) for k in turning), default=self.time))
        if self.coupling.gear is None:
            standing = self.timeline.positions(self.time)
            self.spindles.free.update(turning)
            for axis in turning:
                self.registers.orient(axis, standing[axis])
        self.note_extents()

    # The gear box

    def _couple(self, command: Couple) -> Steps[None]:
        """Close an older engagement, turn the master by R, engage."""
        gear, old = command.gear, self.coupling.gear
        self._require_servos(gear)
        sensor = (yield from self._encoders()) if old and old.follow else None
        before = self.coupling.close(self.time, sensor, self._line)
        if command.phase:
            yield from self._wait(self.coupling.advance_master(gear, command.phase, self.time))
            self.coupling.count_advance(gear, command.phase)
        sensor = (yield from self._encoders()) if gear.follow else None
        jump = (self.coupling.engage(gear, self.time, sensor, self._line) - before) / DEG_PER_S
        self._note_turning(gear)
        if abs(jump) > NOTHING:
            found = f"a jump of {jump:+.3f} rpm"
            self._warn(Alarm(number="HT9100", found=found, span=self._span))

    def _require_servos(self, gear: GearBox) -> None:
        """PS0197: the axes of a gear box are in position control, an analogue master apart."""
        off = self.panel.inputs.columns(AxisInput.SERVO_OFF)
        for column in (gear.master, gear.slave):
            if column in off:
                letter = self.machine.axes[column].letter
                found = f"{letter} with its servo off"
                raise alarm("PS0197", found, self._span, valid=f"signal SVF{letter} = 0")

    def _note_turning(self, gear: GearBox) -> None:
        self.coupling.note_peaks(abs(self.timeline.tracks[gear.master].speed(self.time)), 0.0)

    def _uncouple(self) -> Steps[None]:
        """Release the gear box; the slave brakes."""
        gear = self.coupling.gear
        if gear is None:
            return
        sensor = (yield from self._encoders()) if gear.follow else None
        yield from self._wait(self.coupling.release(self.time, sensor, self._line))
        self.note_extents()

    # Stopping

    def reset(self) -> Steps[None]:
        """After the motion has come to rest: sync as 201#3 says; spindles out of sync stop."""
        self._reset, self._underway, self._threading = False, None, False
        self._by_hand.clear()
        if not self.machine.parameters.bit(201, 3):
            yield from self._uncouple()
        gear = self.coupling.gear
        held = (gear.master, gear.slave) if gear else ()
        yield from self._stop_spindles([k for k in range(len(self.machine.axes)) if k not in held])

    def _emergency_stop(self) -> Steps[None]:
        """Every axis brakes at once as hard as it can; the gear box is released. Raises EmergencyStop."""
        gear, path = self.coupling.gear, self._underway
        sensor = (yield from self._encoders()) if gear and gear.follow else None
        counted = self._stray(path, {})
        self._absorb(counted)
        turning = [k for k in range(len(self.machine.axes)) if self.spindles.driven(k, self.time)]
        end = max(self._brake(k) for k in range(len(self.machine.axes)) if not gear or k != gear.slave)
        released = self.coupling.release(self.time, sensor, self._line)
        self.time = max(end, released)
        if gear:
            master = self.timeline.tracks[gear.master]
            self.registers.release(gear.master, master.at(self.time) - master.at(released))
        self._absorb(self._stray(path, counted))
        for axis in turning:
            if path is None or axis not in path.slides:
                self.spindles.commanded[axis] = 0.0
                self.spindles.free.add(axis)
                if gear is None:
                    self.registers.orient(axis, self.timeline.tracks[axis].at(self.time))
        self.spindles.surface, self._underway = None, None
        self.panel.emergency, self.panel.running, self._reset, self._threading = True, False, False, False
        self._by_hand.clear()
        self.note_extents()
        raise EmergencyStop

    def _brake(self, axis: int) -> float:
        """Brake an axis from now on as hard as it can; returns the end [s]."""
        track, rate = self.timeline.tracks[axis], self.machine.axes[axis].acceleration
        position, speed = track.at(self.time), track.speed(self.time)
        duration = abs(speed) / rate
        if duration > 0.0:
            track.add(self.time, position, speed, -math.copysign(rate, speed))
        track.add(self.time + duration, position + 0.5 * speed * duration)
        self.peaks.note({axis: 1.0}, abs(speed), rate if speed else 0.0)
        self.spindles.arrival[axis] = self.time + duration
        return self.time + duration

    def _stray(self, path: AnyPath | None, counted: Travel) -> Travel:
        """How far the slides of a path are from where the displays show them, beyond what is counted."""
        if path is None:
            return {}
        _, _, shown = path.between(0.0, path.settled)
        tracks = self.timeline.tracks
        return {
            k: tracks[k].at(self.time) - path.base[k] - shown.get(k, 0.0) - counted.get(k, 0.0)
            for k in path.slides
        }

    def _absorb(self, slides: Travel) -> None:
        """The displays follow motion of the slides that no path describes."""
        machine, program = self._cartesian(slides), self._program(slides)
        self.registers.move(program, machine)
        epoch = self.timeline.coupling
        if epoch and epoch.weights and epoch.gear.kind is SyncKind.HOBBING:
            shift = sum(weight * slides.get(k, 0.0) for k, weight in epoch.weights.items())
            self.registers.compensate(epoch.gear.slave, shift)
