"""F: the feed of cutting moves and the lead of threads."""

from collections.abc import Iterable
from dataclasses import replace

from controller.commands import Feed
from controller.language.draft import Draft
from controller.laws.gearbox import MM_PER_INCH
from controller.tables.codes import Group, g_name

G32, G76, G92 = 320, 760, 920


def interpret_feed(draft: Draft, mode_before: int) -> None:
    """F, kept for its mode: after a change between G98 and G99 an F of the new mode is due.

    In a block of G32, G92 or G76 F is the lead, per turn whatever the mode, and the feed as well.
    """
    if draft.modal.codes[Group.FEED] != mode_before:
        draft.modal = replace(draft.modal, feed=None)
    word = draft.take("F")
    if word is None:
        return
    thread = draft.modal.codes[Group.MOTION] in (G32, G92) or G76 in draft.block.codes
    value = draft.reader.feed(word, per_revolution=thread or draft.modal.per_revolution)
    if thread:
        draft.modal = replace(draft.modal, lead=value * (MM_PER_INCH if draft.reader.inch else 1.0))
    if value != draft.modal.feed or draft.reader.inch != draft.modal.feed_inch:
        draft.modal = replace(draft.modal, feed=value, feed_inch=draft.reader.inch)


def feed_per_minute(value: float, *, inch: bool) -> Feed:
    """The feed of an F by G98 [mm/s | deg/s]; `inch` where it counts inches."""
    return Feed(value=value * (MM_PER_INCH if inch else 1.0) / 60.0)


def feed_per_revolution(value: float, *, inch: bool, measured: bool) -> Feed:
    """The feed of an F by G99 [mm | deg per turn of the work]."""
    return Feed(value=value * (MM_PER_INCH if inch else 1.0), per_revolution=True, measured=measured)


def feed_in_force(draft: Draft, columns: Iterable[int]) -> Feed:
    """The feed of a move of these axes; PS0011 without one, HT9007 where it would wait for ever."""
    modal = draft.modal
    place = draft.code_word(modal.codes[Group.MOTION])
    if not modal.feed:
        found = "F0" if modal.feed is not None else f"no F since {g_name(modal.codes[Group.FEED])}"
        raise draft.alarm("PS0011", found, place)
    # of rotary axes alone F counts degrees also in inches
    inch = modal.feed_inch and any(not draft.machine.axes[column].rotary for column in columns)
    if not modal.per_revolution:
        return feed_per_minute(modal.feed, inch=inch)
    check_turning(draft, f"F{modal.feed:g} by G99")
    measured = modal.gear is None or not draft.machine.parameters.bit(201, 2)
    if measured:
        check_encoder(draft, f"F{modal.feed:g} by G99")
    return feed_per_revolution(modal.feed, inch=inch, measured=measured)


def check_turning(draft: Draft, what: str) -> None:
    """HT9007 for a motion bound to the turns of a work axis that stands still."""
    modal = draft.modal
    if modal.gear:
        still, cause = modal.sync_rpm == 0.0, "S0 in sync: the work axis stands still"
    else:
        work = draft.machine.work_spindle
        turns = work is not None and draft.motion.spindles.turning(work, draft.motion.time)
        still, cause = not (modal.direction or turns), "the work spindle stands still"
    if still:
        raise draft.alarm("HT9007", f"{what}, {cause}", draft.code_word(modal.codes[Group.MOTION]))


def check_encoder(draft: Draft, what: str) -> None:
    """HT9005 for a motion bound to the measured speed or angle of a work spindle without encoder."""
    work = draft.machine.work_spindle
    if work is not None and not draft.machine.axes[work].encoder:
        letter = draft.letter(work)
        place = draft.code_word(draft.modal.codes[Group.MOTION])
        valid = f"an encoder: parameter 9005#1.{letter} = 1"
        raise draft.alarm("HT9005", f"{what}, the work spindle {letter} has no encoder", place, valid=valid)


def lead_in_force(draft: Draft) -> float:
    """The lead of a thread [mm per turn]; PS0011 without one."""
    if not draft.modal.lead:
        name = g_name(G76 if G76 in draft.block.codes else draft.modal.codes[Group.MOTION])
        place = draft.code_word(G76) or draft.code_word(draft.modal.codes[Group.MOTION])
        raise draft.alarm("PS0011", f"{name} without a lead", place, valid="F, the lead per turn, above 0")
    return draft.modal.lead
