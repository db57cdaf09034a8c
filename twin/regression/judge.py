"""What came out of a run against the `[expect]` of its job."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from twin.inspection.keys import Figure, figure
from twin.job.expect import Between, Expectation

NOT_MEASURED = "not measured"


@dataclass(frozen=True, slots=True, kw_only=True)
class Miss:
    """An expectation that was not met."""

    key: str
    expected: str
    got: str
    off_by: str
    """empty where it is no number"""


def misses(
    expectations: Iterable[Expectation],
    inspection: Mapping[str, Any],
    *,
    alarms: Sequence[str] = (),
    warnings: Sequence[str] = (),
) -> tuple[Miss, ...]:
    """What was expected and did not come: `inspection` as in inspection.json, numbers of what was raised."""
    raised = {"alarms": alarms, "warnings": warnings}
    found: list[Miss | None] = []
    for one in expectations:
        if isinstance(one.wanted, tuple):
            found.append(_numbers(one.key, one.wanted, raised[one.key]))
        else:
            why = inspection.get("unmeasured", {}).get(one.key, "") or inspection.get("reason", "")
            found.append(_figure(one.key, one.wanted, figure(inspection, one.key), why))
    return tuple(miss for miss in found if miss is not None)


def table(missed: Sequence[Miss]) -> list[str]:
    """The misses in aligned columns, with a head; nothing where there are none."""
    if not missed:
        return []
    rows = [("key", "expected", "got", "off by"), *((m.key, m.expected, m.got, m.off_by) for m in missed)]
    widths = [max(len(row[k]) for row in rows) for k in range(4)]
    return [
        "  " + "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]


def _numbers(key: str, wanted: tuple[str, ...], raised: Sequence[str]) -> Miss | None:
    got = sorted(set(raised))
    if got == sorted(set(wanted)):
        return None
    off = [f"missing {n}" for n in sorted(set(wanted) - set(got))]
    off += [f"unexpected {n}" for n in got if n not in wanted]
    return Miss(key=key, expected=_listed(sorted(set(wanted))), got=_listed(got), off_by=", ".join(off))


def _listed(numbers: Sequence[str]) -> str:
    return ", ".join(numbers) or "none"


def _figure(key: str, wanted: Between | str | bool, got: Figure, why: str) -> Miss | None:
    if not isinstance(wanted, Between):
        return (
            None if got == wanted else Miss(key=key, expected=_said(wanted), got=_said(got, why), off_by="")
        )
    if isinstance(got, bool | str) or got is None:
        return Miss(key=key, expected=str(wanted), got=_said(got, why), off_by="")
    off = wanted.off(got)
    return Miss(key=key, expected=str(wanted), got=f"{got:.10g}", off_by=f"{off:+.4g}") if off else None


def _said(value: Figure, why: str = "") -> str:
    if value is None:
        return f"{NOT_MEASURED}: {why}" if why else NOT_MEASURED
    return str(value).lower() if isinstance(value, bool) else str(value)
