"""Blocks of the gear box: G81 and G80 (hobbing), G51.2 and G50.2 (polygon), and S while it is engaged."""

from dataclasses import dataclass, replace

from controller.commands import Couple, SpindleSpeed, Uncouple
from controller.language.draft import Draft
from controller.language.lexer import Word
from controller.laws.gearbox import MM_PER_INCH, GearBox, SyncKind, helix_rate, helix_rate_inch, polygon_rate
from controller.tables.codes import Group
from controller.tables.machine_data import INCREMENT_LETTER

G80, G81, G50_2, G51_2 = 800, 810, 502, 512
STEEP = 85.0
"""[deg] a helix angle beyond this is warned about"""


def interpret_sync(draft: Draft) -> bool:
    """Interpret a block with G81, G80, G51.2 or G50.2; True where the block is done with that."""
    codes = draft.block.codes
    if G81 in codes:
        _hobbing(draft)
        return True
    if G51_2 in codes:
        _polygon(draft)
        return True
    if G80 in codes and draft.modal.gear:
        _cancel(draft, G80, SyncKind.HOBBING, "PS1594")
        return True
    if G50_2 in codes:
        return _polygon_off(draft)
    return False


def _polygon_off(draft: Draft) -> bool:
    """G50.2 stands alone in its block, in sync and out of it (polygon, 注 2)."""
    if draft.modal.gear:
        _cancel(draft, G50_2, SyncKind.POLYGON, "PS0219")
    else:
        _alone(draft, G50_2, "PS0219")
        draft.set_code(Group.POLYGON, G50_2)
    return True


def _cancel(draft: Draft, code: int, kind: SyncKind, shared: str) -> None:
    gear = draft.modal.gear
    if gear and gear.kind is not kind:
        draft.refuse_in_sync(str(draft.code_word(code)), draft.code_word(code))
    _alone(draft, code, shared)
    draft.modal = replace(draft.modal, gear=None, sync_rpm=0.0)
    draft.set_code(*_OFF[kind])
    draft.commands.append(Uncouple())


_ON = {SyncKind.HOBBING: (Group.HOBBING, G81), SyncKind.POLYGON: (Group.POLYGON, G51_2)}
_OFF = {SyncKind.HOBBING: (Group.HOBBING, G80), SyncKind.POLYGON: (Group.POLYGON, G50_2)}


def _alone(draft: Draft, code: int, number: str, allowed: str = "") -> None:
    """No other word than `allowed` beside the code, no other G code, no M code."""
    for other, word in draft.block.codes.items():
        if other != code:
            raise draft.alarm(number, f"{word} in the block of {draft.code_word(code)}", word)
    for address, word in draft.rest.items():
        if address not in allowed:
            raise draft.alarm(number, f"{word} in the block of {draft.code_word(code)}", word)
    if m_code := draft.block.m_code:
        found = f"{m_code.name} in the block of {draft.code_word(code)}"
        raise draft.alarm(number, found, draft.block.m_word)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Bounds:
    """Inclusive range of a word, zero excluded or not."""

    low: float
    high: float
    zero: bool = True

    def holds(self, value: float) -> bool:
        return self.low <= value <= self.high and (self.zero or value != 0)

    def __str__(self) -> str:
        return f"{self.low:.7g} to {self.high:.7g}" + ("" if self.zero else " but 0")


_TEETH = _Bounds(low=1, high=1000)
_STARTS = _Bounds(low=-1000, high=1000, zero=False)
_MODULE = _Bounds(low=0.01, high=100.0)
_PITCH = _Bounds(low=0.01, high=254.0)
_HELIX = _Bounds(low=-90.0, high=90.0)
_CUTTERS = _Bounds(low=1, high=999)
_SIDES = _Bounds(low=-999, high=999, zero=False)
_PHASE = _Bounds(low=0.0, high=9999.999)


def _integer(draft: Draft, address: str, bounds: _Bounds, number: str) -> int | None:
    word = draft.take(address)
    if word is None:
        return None
    return int(_within(draft, draft.reader.integer(word, number), word, bounds, number))


def _within(draft: Draft, value: float, word: Word, bounds: _Bounds, number: str) -> float:
    if not bounds.holds(value):
        raise draft.alarm(number, str(word), word, valid=f"{word.address} {bounds}")
    return value


def _hobbing(draft: Draft) -> None:
    """G81 T L (Q P): hobbing, 指令格式 and 代码说明."""
    word = draft.code_word(G81)
    gear = draft.modal.gear
    if gear and gear.kind is SyncKind.POLYGON:
        draft.refuse_in_sync("G81", word)
    if gear and not draft.machine.parameters.bit(201, 4):
        raise draft.alarm(
            "PS1595", "G81 in sync with 201#4 = 0", word, valid="G80 first, or parameter 201#4 = 1"
        )
    number = "PS1594"
    _alone(draft, G81, number, allowed="TLQP")
    teeth = _integer(draft, "T", _TEETH, number)
    if teeth is None:
        raise draft.alarm(number, "G81 without T", word)
    starts = _integer(draft, "L", _STARTS, number) or 1
    pitch_word, angle_word = draft.take("Q"), draft.take("P")
    if (pitch_word is None) != (angle_word is None):
        alone = pitch_word or angle_word
        raise draft.alarm(
            number, f"only {alone} of Q and P", alone, valid="both Q and P, or neither for a spur gear"
        )
    master, slave = _hobbing_axes(draft, word)
    axial, rate = None, 0.0
    module, angle = None, None
    if pitch_word and angle_word:
        bounds = _PITCH if draft.reader.inch else _MODULE
        pitch = _within(draft, draft.reader.pitch(pitch_word), pitch_word, bounds, number)
        angle = _within(draft, draft.reader.angle(angle_word), angle_word, _HELIX, number)
        if abs(angle) > STEEP:
            draft.warn("HT9102", f"{angle_word}", angle_word)
        axial = _axial_axis(draft, word)
        sense = draft.machine.parameters.integer(9003)
        if draft.reader.inch:
            module = MM_PER_INCH / pitch
            rate = helix_rate_inch(teeth=teeth, diametral_pitch=pitch, helix_angle=angle, sense=sense)
        else:
            module = pitch
            rate = helix_rate(teeth=teeth, normal_module=pitch, helix_angle=angle, sense=sense)
    if draft.machine.pair:
        draft.warn("HT9112", "G81 with 8200#0 = 1", word)
    gear = GearBox(
        kind=SyncKind.HOBBING,
        master=master,
        slave=slave,
        numerator=starts,
        denominator=teeth,
        axial=axial,
        axial_rate=rate,
        follow=draft.machine.parameters.bit(201, 7),
    )
    _engage(draft, Couple(gear=gear, normal_module=module, helix_angle=angle), word)


def _polygon(draft: Draft) -> None:
    """G51.2 P Q R A: polygon, 代码说明."""
    word = draft.code_word(G51_2)
    gear = draft.modal.gear
    if draft.machine.pair:
        raise draft.alarm("HT9014", "G51.2 with 8200#0 = 1", word)
    if gear and gear.kind is SyncKind.HOBBING:
        draft.refuse_in_sync("G51.2", word)
    if gear and not draft.machine.parameters.bit(201, 4):
        raise draft.alarm("PS0217", "G51.2 in sync with 201#4 = 0", word)
    number = "PS0218"
    _alone(draft, G51_2, "PS0219", allowed="PQRA")
    cutters = _integer(draft, "P", _CUTTERS, number)
    sides = _integer(draft, "Q", _SIDES, number)
    if cutters is None or sides is None:
        raise draft.alarm(number, f"G51.2 without {'P' if cutters is None else 'Q'}", word)
    phase_word, lead_word = draft.take("R"), draft.take("A")
    phase = _within(draft, draft.reader.angle(phase_word), phase_word, _PHASE, number) if phase_word else 0.0
    lead = draft.reader.length(lead_word) if lead_word else 0.0
    if sides < 0:
        draft.warn("HT9103", f"Q{sides}", word)
    slave, master = _hobbing_axes(draft, word)
    if gear and phase and draft.motion.spindles.turning(master, draft.motion.time):
        raise draft.alarm("HT9008", f"R while {draft.letter(master)} turns", phase_word)
    gear = GearBox(
        kind=SyncKind.POLYGON,
        master=master,
        slave=slave,
        numerator=sides,
        denominator=cutters,
        axial=_axial_axis(draft, word) if lead else None,
        axial_rate=polygon_rate(sides=sides, cutters=cutters, lead=lead) if lead else 0.0,
        follow=draft.machine.parameters.bit(201, 7),
    )
    _engage(draft, Couple(gear=gear, phase=phase, lead=lead), word)


def _hobbing_axes(draft: Draft, word: Word | None) -> tuple[int, int]:
    """Columns of tool (197) and work (198); PS1593 unless both are different rotary axes of type A."""
    parameters, machine = draft.machine.parameters, draft.machine
    tool = machine.column_of_number(parameters.integer(197))
    work = machine.column_of_number(parameters.integer(198))
    unset = parameters.integer(197) == 0 and parameters.bit(201, 7) and G81 in draft.block.codes
    if unset:
        tool = machine.tool_spindle  # hobbing, 注 3: the spindle encoder is the master then
    for number, column in ((197, tool), (198, work)):
        value = parameters.integer(number)
        if column is None:
            raise draft.alarm("PS1593", f"parameter {number} = {value}, no axis of this machine", word)
        axis = machine.axes[column]
        draft.motion.references.require(column, axis.letter, draft.block.place(word) if word else None)
        if not axis.type_a or axis.spindle_max == 0.0:
            raise draft.alarm(
                "PS1593", f"parameter {number} = {value}: {axis.letter} is no rotary axis of type A", word
            )
    if tool is None or work is None or tool == work:
        raise draft.alarm("PS1593", f"parameters 197 and 198 both {parameters.integer(198)}", word)
    return tool, work


def _axial_axis(draft: Draft, word: Word | None) -> int:
    number = draft.machine.parameters.integer(199)
    column = draft.machine.column_of_number(number)
    if column is None or draft.machine.axes[column].rotary:
        raise draft.alarm("PS1593", f"parameter 199 = {number}, no linear axis", word)
    return column


def _engage(draft: Draft, command: Couple, word: Word | None) -> None:
    motion, gear = draft.motion, command.gear
    _check_drives(draft, gear, word)
    if draft.modal.gear is None:
        for column in (gear.master, gear.slave):
            if motion.spindles.turning(column, motion.time):
                raise draft.alarm("HT9008", f"{draft.letter(column)} turns out of sync", word)
            if column in motion.spindles.free and not (gear.follow and column == gear.master):
                found = f"{draft.letter(column)} not in position control"
                raise draft.alarm("PS0197", found, word, valid=orientation(draft, column))
    _check_slave_speed(draft, gear, draft.modal.sync_rpm, word)
    draft.modal = replace(draft.modal, gear=gear)
    draft.set_code(*_ON[gear.kind])
    draft.commands.append(command)


def _check_drives(draft: Draft, gear: GearBox, word: Word | None) -> None:
    """PS1593: the slave is a servo axis; a measured master has an encoder (rulings, section 2)."""
    slave, master = draft.machine.axes[gear.slave], draft.machine.axes[gear.master]
    if slave.analogue:
        found = f"{slave.letter}, the slave axis, an analogue spindle"
        raise draft.alarm("PS1593", found, word, valid=f"a servo axis: parameter 9005#0.{slave.letter} = 0")
    if gear.follow and not master.encoder:
        found = f"{master.letter}, the master axis of the follow type, without an encoder"
        raise draft.alarm("PS1593", found, word, valid=f"an encoder: parameter 9005#1.{master.letter} = 1")


def orientation(draft: Draft, column: int) -> str:
    """What takes a rotary axis back to position control."""
    letter = draft.letter(column)
    if draft.machine.axes[column].analogue:
        return f"a servo axis: {letter} is an analogue spindle (parameter 9005#0)"
    if column == draft.machine.work_spindle:
        return "M19 or G28 H0 before the block"
    return f"G28 {INCREMENT_LETTER.get(letter, letter)}0 before the block"


def _check_slave_speed(draft: Draft, gear: GearBox, rpm: float, word: Word | None) -> None:
    slave = draft.machine.axes[gear.slave]
    speed = abs(rpm * gear.ratio)
    if speed > slave.spindle_max:
        number = "PS1596" if gear.kind is SyncKind.HOBBING else "PS5018"
        found = f"{speed:.0f} rpm asked of {slave.letter}"
        raise draft.alarm(number, found, word, valid=f"at most {slave.spindle_max:.0f} rpm of {slave.letter}")


def sync_speed(draft: Draft, word: Word) -> None:
    """S while the gear box is engaged: speed and sense of the master, 0 stops it (同步过程中)."""
    gear = draft.modal.gear
    if gear is None:
        return
    rpm = float(draft.reader.integer(word))
    if gear.follow and rpm < 0.0:
        draft.warn("HT9106", str(word), word)
        rpm = -rpm
    elif rpm < 0.0 and gear.kind is SyncKind.HOBBING:
        draft.warn("HT9101", str(word), word)
    master = draft.machine.axes[gear.master]
    if abs(rpm) > master.spindle_max:
        found = f"{word} for {master.letter}"
        raise draft.alarm(
            "PS1544", found, word, valid=f"at most {master.spindle_max:.0f} rpm of {master.letter}"
        )
    _check_slave_speed(draft, gear, rpm, word)
    turn_master(draft, rpm)


def turn_master(draft: Draft, rpm: float) -> None:
    """The master heads for a speed [rpm]; a stop is waited for."""
    if gear := draft.modal.gear:
        draft.modal = replace(draft.modal, sync_rpm=rpm)
        draft.commands.append(SpindleSpeed(axis=gear.master, rpm=rpm, wait=rpm == 0.0))
