"""The folder of a compensation: beside both results, the page, its values, and where they come from."""

import json
from pathlib import Path

from twin.compensation.page import render
from twin.compensation.text import as_json
from twin.compensation.walk import Compensation
from twin.output.folder import MARK
from twin.output.provenance import provenance


def write_compensation(folder: Path, found: Compensation) -> None:
    """Write `compensation.html`, `compensation.json` and `provenance.json` into the folder."""
    job = found.job
    (folder / "compensation.html").write_text(render(found), encoding="utf-8")
    _json(folder / "compensation.json", as_json(found))
    probing = job.probe.program if job.probe and job.probe.program else ""
    origin = provenance(
        {"job": job.path, "program": job.program, "probing": job.path.parent / probing},
        {"kind": "compensation", "ideal": found.after.outcome.options.ideal},
    )
    _json(folder / MARK, origin)


def _json(path: Path, value: object) -> None:
    path.write_text(json.dumps(value, indent=2, ensure_ascii=False, allow_nan=False) + "\n", encoding="utf-8")
