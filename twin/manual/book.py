"""The whole manual, and how something is found in it."""

import difflib
import re
from collections.abc import Callable, Iterator
from functools import cache

from twin.errors import InputError
from twin.manual.alarms import advice, alarms, warnings
from twin.manual.codes import g_codes, m_codes
from twin.manual.entry import Entry, spelled
from twin.manual.events import events
from twin.manual.parameters import parameters
from twin.manual.signals import signals

_CHAPTERS: tuple[Callable[[], Iterator[Entry]], ...] = (
    g_codes,
    m_codes,
    alarms,
    warnings,
    advice,
    parameters,
    signals,
    events,
)
_FAMILY = re.compile(r"^MC\d+$", re.ASCII)
"""alarms that programs raise themselves: one entry for all of them"""
_NEAR = 8
"""names to offer where nothing is found"""


@cache
def entries() -> tuple[Entry, ...]:
    """Everything that the manual explains, in its order."""
    return tuple(entry for chapter in _CHAPTERS for entry in chapter())


def find(query: str) -> tuple[Entry, ...]:
    """The entries of a name: PS1594, G81, g1, 201, 201#4, 1320.Z, NOZAGC, "feed hold".

    Raises InputError with the nearest names, or those whose title holds the words.
    """
    wanted = _FAMILY.sub("MC3000", spelled(query))
    found = tuple(entry for entry in entries() if wanted in entry.names)
    if found:
        return found
    near = _near(query)
    offered = (
        ", ".join(near) if near else "a code, alarm, parameter, signal or event; explain alone lists them"
    )
    raise InputError(
        f"nothing to explain by the name {query!r}", remedy=f"near: {offered}" if near else offered
    )


def _near(query: str) -> list[str]:
    words = query.lower().split()
    titled = [
        entry.name for entry in entries() if words and all(word in entry.title.lower() for word in words)
    ]
    shown = {name: entry.name for entry in entries() for name in entry.names}
    close = [shown[name] for name in difflib.get_close_matches(spelled(query), shown, n=_NEAR, cutoff=0.6)]
    return list(dict.fromkeys([*titled, *close]))[:_NEAR]
