"""`hobtwin explain`: what a name means."""

import argparse
import json

from twin.errors import ExitCode
from twin.manual.book import entries, find
from twin.manual.entry import Entry
from twin.manual.render import as_list, as_markdown, as_text


def explain_command(options: argparse.Namespace) -> ExitCode:
    """Explain names; without any, list them all. Raises InputError for a name that nobody knows."""
    found: tuple[Entry, ...] = entries()
    named = bool(options.name)
    if named:
        found = tuple(dict.fromkeys(entry for name in _joined(options.name) for entry in find(name)))
    if options.format == "json":
        print(json.dumps([_json(entry) for entry in found], indent=2, ensure_ascii=False))
    elif options.format == "markdown":
        print(as_markdown(found))
    else:
        print(as_text(found) if named or options.all else as_list(found))
    return ExitCode.FINE


def _joined(words: list[str]) -> list[str]:
    """`explain feed hold` without quotes is one name, `explain G81 G80` are two."""
    known = frozenset().union(*(entry.names for entry in entries()))
    together = "".join(words).upper()
    return [" ".join(words)] if together in known else words


def _json(entry: Entry) -> dict[str, object]:
    return {
        "chapter": entry.chapter.value,
        "name": entry.name,
        "title": entry.title,
        **{label.lower(): text for label, text in entry.rows},
    }
