"""Where a key stands in a TOML text, for messages; a plain scan, as tomllib keeps no places."""

import re

_HEADER = re.compile(r"^\s*\[(\[)?\s*([^\]]+?)\s*\]\]?")
_KEY = re.compile(r"""^\s*((?:[\w-]+|"[^"]*"|'[^']*')(?:\s*\.\s*(?:[\w-]+|"[^"]*"|'[^']*'))*)\s*=""")


def line_of(text: str, path: tuple[str, ...], nth: int = 0) -> int | None:
    """Line (from 1) of the key or table `path`, or of the nearest enclosing table that is written out.

    Of an array of tables, `[[events]]`, the one that `nth` counts from 0.
    """
    best: tuple[int, int] | None = None
    table: tuple[str, ...] = ()
    seen: dict[tuple[str, ...], int] = {}
    for number, line in enumerate(text.splitlines(), start=1):
        if header := _HEADER.match(line):
            here = table = _parts(header.group(2))
            if header.group(1):
                seen[table] = seen.get(table, -1) + 1
        elif key := _KEY.match(line):
            here = table + _parts(key.group(1))
        else:
            continue
        if (
            seen.get(table, nth) == nth
            and path[: len(here)] == here
            and (best is None or len(here) > best[0])
        ):
            best = (len(here), number)
    return best[1] if best else None


def _parts(dotted: str) -> tuple[str, ...]:
    found = re.findall(r"""[\w-]+|"[^"]*"|'[^']*'""", dotted)
    return tuple(part.strip("\"'") for part in found)
