"""M98, M99, G65, G66, G67: calls of other programs and the way back."""

from dataclasses import replace
from functools import partial

from controller.commands import Arc, MachineMove, Move, Skip, Thread
from controller.language.draft import Draft
from controller.language.lexer import Word
from controller.language.macro.arguments import COUNTED, argument_numbers
from controller.language.modal import ModalCall
from controller.tables.alarms import AlarmError
from controller.tables.codes import Group

G65, G66, G67 = 650, 660, 670
_OLD_FORM = 10_000
"""M98 P30100: three times O0100"""
_MOTIONS = (Move, Arc, Thread, Skip, MachineMove)


def interpret_subprogram(draft: Draft) -> None:
    """M98 and M99."""
    number = draft.block.m_code.number if draft.block.m_code else None
    if number == 98:
        _call(draft)
    elif number == 99:
        _return(draft)


def _call(draft: Draft) -> None:
    """M98 P1234 L5, or in the old form M98 P51234."""
    word, times = draft.take("P"), draft.take("L")
    if word is None:
        raise draft.alarm("PS0076", "M98 without P", valid="P and the O number")
    value, repeats = draft.reader.natural(word), _repeats(draft, times)
    start = draft.flow.program.find(value)
    if start is None and times is None and value >= _OLD_FORM:
        repeats, value = divmod(value, _OLD_FORM)
        start = draft.flow.program.find(value)
    if start is None:
        raise _not_found(draft, word)
    draft.flow.check_level(draft.block.place(word), macro=False)
    draft.go = partial(
        draft.flow.enter, start, back=draft.index + 1, repeats=repeats - 1, arguments=None, modal=False
    )


def _not_found(draft: Draft, word: Word) -> AlarmError:
    known = ", ".join(f"O{number:04d}" for number in sorted(draft.flow.program.starts)[:10]) or "none"
    valid = f"an O number of this file ({known}) or of its folder"
    return draft.alarm("PS0076", str(word), word, valid=valid)


def _repeats(draft: Draft, word: Word | None) -> int:
    repeats = draft.reader.natural(word) if word else 1
    if repeats == 0:
        raise draft.alarm("HT9012", str(word), word, valid="at least one run")
    return repeats


def _return(draft: Draft) -> None:
    """M99: back to the caller, with P to a sequence number of it; in the main program back to its start."""
    word = draft.take("P")
    flow, target = draft.flow, None
    span = draft.block.place(word) if word else draft.block.span
    if word:
        home = flow.frame if flow.main else flow.frames[-2]
        target = flow.program.sequence(draft.reader.natural(word), home.start)
        if target is None:
            raise draft.alarm("PS0060", f"N{word.text}", word)
    if flow.main:
        draft.go = partial(flow.jump, flow.frame.start if target is None else target, draft.index, span)
    else:
        draft.go = partial(flow.leave, span, target)


def interpret_macro_call(draft: Draft) -> bool:
    """G65 and G66, which leave no room for anything else in their block; True where the block is one."""
    codes = draft.block.codes
    if G65 not in codes and G66 not in codes:
        return False
    word = draft.take("P")
    if word is None:
        name = "G65" if G65 in codes else "G66"
        raise draft.alarm("PS0076", f"{name} without P", valid="P and the O number of the macro")
    number, repeats = draft.reader.natural(word), _repeats(draft, draft.take("L"))
    start = draft.flow.program.find(number)
    if start is None:
        raise _not_found(draft, word)
    arguments = _arguments(draft)
    if G65 in codes:
        draft.flow.check_level(draft.block.place(word), macro=True)
        draft.go = partial(
            draft.flow.enter,
            start,
            back=draft.index + 1,
            repeats=repeats - 1,
            arguments=arguments,
            modal=False,
        )
        return True
    if draft.modal.call:
        raise draft.alarm(
            "HT9012", "G66 while another G66 is in force", draft.code_word(G66), valid="G67 first"
        )
    draft.set_code(Group.MACRO, G66)
    draft.modal = replace(draft.modal, call=ModalCall(number=number, repeats=repeats, arguments=arguments))
    return True


def _arguments(draft: Draft) -> dict[int, float]:
    """Number of the local variable -> value; of two for the same variable the later one holds."""
    words = draft.block.arguments
    values: dict[int, float] = {}
    for word, number in zip(words, argument_numbers([w.address for w in words]), strict=True):
        if number is None:
            valid = "A to F, H to K, M, Q to Z; I J K at most ten times"
            raise draft.alarm("PS0129", f"{word} as an argument", word, valid=valid)
        plain = word.value is None and word.address in COUNTED
        values[number] = float(word.text) if plain else draft.reader.argument(word)
    return values


def interpret_modal_call(draft: Draft) -> None:
    """G67, and the macro of G66 behind every block with motion but those of the macro itself."""
    if G67 in draft.block.codes and draft.modal.call:
        draft.modal = replace(draft.modal, call=None)
    call, flow = draft.modal.call, draft.flow
    if call is None or draft.go is not None or flow.modal_call_running:
        return
    if not any(isinstance(command, _MOTIONS) for command in draft.commands):
        return
    start = flow.program.find(call.number)
    if start is None:
        raise draft.alarm("PS0076", f"O{call.number:04d} of G66")
    flow.check_level(draft.block.span, macro=True)
    draft.go = partial(
        flow.enter,
        start,
        back=draft.index + 1,
        repeats=call.repeats - 1,
        arguments=dict(call.arguments),
        modal=True,
    )
