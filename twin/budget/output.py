"""A budget's folder: `budget.html`, `budget.json`, `provenance.json`."""

import json
from pathlib import Path

from twin.budget.draw_up import Budget, Share
from twin.budget.page import render
from twin.job.schema import Job
from twin.output.folder import MARK, result_folder
from twin.output.provenance import provenance


def write_budget(out: Path, job: Job, budget: Budget) -> None:
    """Write the folder `out` whole. Raises InputError where it cannot be."""
    origin = provenance({"job": job.path, "program": job.program}, {"kind": "budget"})
    with result_folder(out) as folder:
        (folder / "budget.html").write_text(render(budget), encoding="utf-8")
        _json(folder / "budget.json", as_json(budget))
        _json(folder / MARK, origin)


def as_json(budget: Budget) -> dict[str, object]:
    """The budget for programs: µm by item; the sources as they should be mended."""
    return {
        "title": budget.title,
        "accuracy_class": budget.accuracy_class,
        "tolerances_um": budget.tolerances,
        "process_um": budget.ideal,
        "sources": [_share(budget, share) for share in budget.shares],
        "together": _share(budget, budget.together),
    }


def _share(budget: Budget, share: Share) -> dict[str, object]:
    item, weight = budget.worst(share)
    said: dict[str, object] = {"name": share.name, "words": share.words, "values_um": share.values}
    if share.reason:
        return said | {"reason": share.reason}
    return said | {"worst_item": item, "share_of_tolerance": weight if budget.tolerances else None}


def _json(path: Path, value: object) -> None:
    path.write_text(json.dumps(value, indent=2, ensure_ascii=False, allow_nan=False) + "\n", encoding="utf-8")
