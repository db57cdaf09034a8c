"""S, M03, M04, M05, M19, G96, G97, G50 S: the work spindle out of sync, the master in sync."""

import math
from dataclasses import replace

from controller.commands import ReferenceReturn, SpindleSpeed, SurfaceSpeed
from controller.language.draft import Draft
from controller.language.families.sync_blocks import sync_speed, turn_master
from controller.language.lexer import Word
from controller.tables.codes import M_CODES

G50, G96, G97 = 500, 960, 970
_DIRECTION = {3: 1, 4: -1, 5: 0, 19: 0}


def interpret_spindle(draft: Draft) -> None:
    """S and the M codes that act before the motion of the block."""
    for code in (G96, G97):
        if code in draft.block.codes:
            _mode(draft, code)
    word = draft.take("S")
    if word:
        word = draft.reader.nearest(word)
    number = draft.block.m_code.number if draft.block.m_code else None
    if word and G50 in draft.block.codes:
        _clamp(draft, word)
        word = None
    if draft.modal.gear:
        if number in (3, 4, 19):
            draft.refuse_in_sync(M_CODES[number].name, draft.block.m_word)
        if word:
            sync_speed(draft, word)
        return
    if word:
        _speed(draft, word)
    if number in (3, 4, 19):
        draft.modal = replace(draft.modal, direction=_DIRECTION[number])
    if number == 19:
        work = _work_spindle(draft)
        draft.refuse_analogue(work, draft.block.m_word)
        draft.commands.append(ReferenceReturn(axes=(work,), span=draft.block.span))
    elif number in (3, 4) or (draft.modal.direction and (word or G96 in draft.block.codes)):
        _turn(draft, word)


def stop_spindle(draft: Draft) -> None:
    """M05, after the motion of the block; in sync the same as S0."""
    if draft.modal.gear:
        turn_master(draft, 0.0)
        return
    draft.modal = replace(draft.modal, direction=0)
    work = _work_spindle(draft)
    if draft.motion.spindles.turning(work, draft.motion.time) or work in draft.motion.spindles.free:
        draft.commands.append(SpindleSpeed(axis=work, rpm=0.0, wait=True))


def _mode(draft: Draft, code: int) -> None:
    word = draft.code_word(code)
    if code == G96:
        draft.refuse_in_sync("G96", word)
    elif draft.modal.constant_surface_speed and draft.modal.direction and "S" not in draft.rest:
        work = _work_spindle(draft)
        rpm = abs(draft.motion.timeline.speed(work, draft.motion.time)) / 6.0
        draft.modal = replace(draft.modal, rpm=rpm)  # G97 without S keeps the speed of the moment
        draft.commands.append(SpindleSpeed(axis=work, rpm=draft.modal.direction * rpm))


def _clamp(draft: Draft, word: Word) -> None:
    """G50 S: the highest speed of G96."""
    value = draft.reader.natural(word)
    if value == 0:
        raise draft.alarm("PS1541", "G50 S0", word, valid="a highest speed above 0")
    draft.modal = replace(draft.modal, clamp=float(value))


def _speed(draft: Draft, word: Word) -> None:
    value = float(draft.reader.natural(word))
    if draft.modal.constant_surface_speed:
        draft.modal = replace(draft.modal, surface_speed=value, surface_inch=draft.reader.inch)
        return
    top = draft.machine.axes[_work_spindle(draft)].spindle_max
    if value > top:
        raise draft.alarm("PS1544", str(word), word, valid=f"at most {top:.0f} rpm")
    draft.modal = replace(draft.modal, rpm=value)


def _turn(draft: Draft, word: Word | None) -> None:
    modal = draft.modal
    work = _work_spindle(draft)
    value = modal.surface_metres if modal.constant_surface_speed else modal.rpm
    if value == 0.0:
        name = draft.block.m_code.name if draft.block.m_code else "S0"
        raise draft.alarm(
            "PS1541", f"{name} without a speed" if word is None else f"{word} with the spindle on", word
        )
    if modal.constant_surface_speed:
        clamp = modal.clamp if math.isfinite(modal.clamp) else draft.machine.axes[work].spindle_max
        radial = _radial_axis(draft)
        speed = modal.direction * value
        draft.commands.append(SurfaceSpeed(axis=work, speed=speed, clamp=clamp, radial=radial))
    else:
        draft.commands.append(SpindleSpeed(axis=work, rpm=modal.direction * value))


def _work_spindle(draft: Draft) -> int:
    work = draft.machine.work_spindle
    if work is None:
        number = draft.machine.parameters.integer(9001)
        raise draft.alarm("HT9005", f"parameter 9001 = {number}, no rotary axis of this machine")
    return work


def _radial_axis(draft: Draft) -> int:
    for column, letter in enumerate(draft.machine.parameters.letters):
        if draft.machine.parameters.integer(1022, letter) == 1:
            return column
    raise draft.alarm("HT9005", "no axis with parameter 1022 = 1 for G96")
