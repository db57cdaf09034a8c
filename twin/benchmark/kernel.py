"""The cutting kernel against booleans."""

import resource
import time

from twin.benchmark.cases import CASES, Case, gear_case
from twin.benchmark.naive import boolean_seconds, naive_seconds
from twin.cutting.cut import CutResult, cut
from twin.errors import InputError
from twin.progress import Reporter, Silent

Figures = dict[str, str | int | float]


def kernel_figures(name: str, reporter: Reporter | None = None) -> Figures:
    """One case: seconds of the kernel, of all tooth passes one by one, and of one boolean of finished gaps.

    Raises InputError for a case that is none.
    """
    if name not in CASES:
        raise InputError(f"no case {name!r}", remedy=f"valid: {', '.join(CASES)}")
    case = CASES[name]()
    tell = reporter or Silent()
    tell.stage("the kernel")
    result, seconds = _timed(case)
    peak = _peak_mib()
    tell.stage("every tooth pass of 2 turns by itself")
    naive = naive_seconds(case, tell.share)
    tell.stage("one boolean of 20 lofts")
    return {
        "case": name,
        "kernel_s": seconds,
        "naive_s": naive,
        "naive_is": "extrapolated from 2 turns",
        "boolean_s": boolean_seconds(),
        "triangles": len(result.remains.faces),
        "peak_mib": peak,
        "max_error_um": result.largest_error_um,
        "facet_error_um": result.facet_error_um,
        "method": result.method,
    }


def scaling_figures() -> list[Figures]:
    """The kernel's time against the number of triangles, from a small gear to one ten times as large."""
    found: list[Figures] = []
    for teeth, width in ((20, 20.0), (20, 100.0), (200, 20.0)):
        case = gear_case(module=2.0, teeth=teeth, width=width, hob_diameter=70.0)
        result, seconds = _timed(case)
        found.append(
            {
                "case": f"m2_z{teeth}_b{width:g}",
                "kernel_s": seconds,
                "triangles": len(result.remains.faces),
                "method": result.method,
            }
        )
    return found


def _timed(case: Case) -> tuple[CutResult, float]:
    start = time.perf_counter()
    result = cut(case.blank, ((case.cutter, case.motion),))
    return result, time.perf_counter() - start


def _peak_mib() -> int:
    return round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
