"""The tables of a job file, turned into dataclasses or refused with file and line."""

import dataclasses
import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, NoReturn, TypeVar, get_args, get_origin, get_type_hints

import msgspec

from twin.errors import HobtwinError, InputError, Place
from twin.job.locate import line_of

T = TypeVar("T")


class Tables:
    """What a TOML file holds. All methods raise InputError, with file and line, for what it does not."""

    def __init__(self, file: Path, text: str, data: dict[str, Any]) -> None:
        self.file = file
        self.text = text
        self.data = data

    def raw(self, path: tuple[str, ...]) -> dict[str, Any]:
        """A table by its path; empty where the job has none."""
        value: Any = self.data
        for name in path:
            value = value.get(name, {})
            if not isinstance(value, dict):
                self.fail(path, f"{'.'.join(path)} is not a table")
        return value

    def table(self, kind: type[T], path: tuple[str, ...], *, extra: tuple[str, ...] = ()) -> T:
        """A table as the dataclass `kind`; `extra` keys are none of its fields."""
        return self.converted(kind, self.raw(path), path, extra=extra)

    def tagged(self, kinds: Mapping[str, type], path: tuple[str, ...]) -> Any:
        """A table as the one of `kinds` that its own `kind` names."""
        raw = self.raw(path)
        kind = raw.get("kind")
        if not isinstance(kind, str) or kind not in kinds:
            self.fail((*path, "kind"), f"unknown kind {kind!r} of {'.'.join(path)}", ", ".join(kinds))
        return self.table(kinds[kind], path, extra=("kind",))

    def converted(
        self,
        kind: type[T],
        raw: Mapping[str, Any],
        path: tuple[str, ...],
        *,
        extra: tuple[str, ...] = (),
        nth: int = 0,
    ) -> T:
        """Values as the dataclass `kind`; `nth` of an array of tables."""
        fields = [f.name for f in dataclasses.fields(kind)]  # pyright: ignore[reportArgumentType]
        self.known(raw, (*extra, *fields), path, nth)
        values = {key: value for key, value in raw.items() if key not in extra}
        self._finite(values, path, nth)
        try:
            return msgspec.convert(values, kind, strict=True)
        except msgspec.ValidationError as cause:
            text, _, at = str(cause).partition(" - at ")
            inner = tuple(re.findall(r"[A-Za-z_]\w*", at.strip("`$")))
            where = (*path, *inner)
            self.fail(where, f"{'.'.join(where)}: {text}", _choices(kind, inner), nth=nth)
        except HobtwinError as cause:
            valid = cause.remedy.removeprefix("valid: ")
            self.fail(path, f"{'.'.join(path)}: {cause.text}", valid, nth=nth)

    def known(
        self, raw: Mapping[str, Any], valid: tuple[str, ...], path: tuple[str, ...], nth: int = 0
    ) -> None:
        """Refuse keys that are none of the `valid` ones."""
        for key in raw:
            if key not in valid:
                what = f"[{'.'.join(path)}]" if path else "the job"
                self.fail((*path, key), f"unknown key {key!r} in {what}", ", ".join(valid), nth=nth)

    def _finite(self, value: Any, path: tuple[str, ...], nth: int = 0) -> None:
        """Refuse numbers that are none, however deep in tables and lists."""
        if isinstance(value, dict):
            for key, inner in value.items():
                self._finite(inner, (*path, key), nth)
        elif isinstance(value, list):
            for inner in value:
                self._finite(inner, path, nth)
        elif isinstance(value, float) and not math.isfinite(value):
            self.fail(path, f"{path[-1]} = {value} is not a finite number", nth=nth)

    def fail(self, path: tuple[str, ...], text: str, valid: str = "", *, nth: int = 0) -> NoReturn:
        """Raise InputError with the line where `path` stands."""
        place = Place(file=str(self.file), line=line_of(self.text, path, nth))
        raise InputError(text, place=place, remedy=f"valid: {valid}" if valid else "")


def _choices(kind: type, path: tuple[str, ...]) -> str:
    """What a field of a few fixed words accepts; empty for any other field."""
    hint = get_type_hints(kind).get(path[0]) if path else None
    return ", ".join(str(word) for word in get_args(hint)) if get_origin(hint) is Literal else ""
