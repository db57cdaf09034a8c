"""The manual as text for a terminal, and as Markdown for the docs."""

import textwrap
from collections.abc import Iterable
from itertools import groupby

from twin.manual.entry import Entry

_WIDTH = 100
"""[characters] of a line on a terminal"""
_HEAD = """# Reference

Everything the controller knows: codes, alarms, parameters, signals, events, and the advice on a job.
Generated from the tables that the program runs on; `hobtwin explain NAME` shows one entry.

```console
hobtwin explain --all --format markdown > docs/reference.md
```

Clauses: *hobbing*, *polygon*, *inclined axis* are the manuals of the control, *rulings* the decisions where
they are silent or contradict themselves.
"""


def as_text(found: Iterable[Entry]) -> str:
    """Entries one below the other."""
    return "\n\n".join("\n".join(_lines(entry)) for entry in found)


def _lines(entry: Entry) -> Iterable[str]:
    yield f"{entry.name}  {entry.title}"
    width = max((len(label) for label, _ in entry.rows), default=0)
    for label, text in entry.rows:
        head, *rest = textwrap.wrap(text, _WIDTH - width - 4, break_long_words=False) or [""]
        yield f"  {label:<{width}}  {head}"
        yield from (" " * (width + 4) + line for line in rest)


def as_list(found: Iterable[Entry]) -> str:
    """Names and titles by chapter."""
    lines: list[str] = []
    for chapter, group in groupby(found, key=lambda entry: entry.chapter):
        entries = list(group)
        width = max(len(entry.name) for entry in entries)
        lines += ["", chapter.value]
        lines += [f"  {entry.name:<{width}}  {_short(entry.title, _WIDTH - width - 4)}" for entry in entries]
    return "\n".join(lines[1:])


def _short(text: str, width: int) -> str:
    """The first words of a text."""
    return textwrap.shorten(text, width, placeholder=" …")


def as_markdown(found: Iterable[Entry]) -> str:
    """The reference page."""
    lines = [_HEAD]
    for chapter, group in groupby(found, key=lambda entry: entry.chapter):
        lines += [f"## {chapter.value}", ""]
        for entry in group:
            lines += [f"### {_escaped(entry.name)}: {_escaped(entry.title)}", ""]
            lines += [f"- {label}: {_escaped(text)}" for label, text in entry.rows]
            lines += [""]
    return "\n".join(lines)


def _escaped(text: str) -> str:
    """Text in which Markdown sees no markup."""
    for sign in "\\*_<>`#[":
        text = text.replace(sign, f"\\{sign}")
    return text
