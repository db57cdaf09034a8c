"""The cutting kernel against booleans."""

import resource
import time

from twin.benchmark.cases import CASES, Case, gear_case
from twin.benchmark.naive import boolean_seconds, naive_seconds
from twin.cutting.cut import CutResult, cut
from twin.errors import InputError

Figures = dict[str, str | int | float]


def kernel_figures(name: str) -> Figures:
    """One case: seconds of the kernel, of all tooth passes one by one, and of one boolean of finished gaps.

    Raises InputError for a case that is none.
    """
    if name not in CASES:
        raise InputError(f"no case {name!r}", remedy=f"valid: {', '.join(CASES)}")
    case = CASES[name]()
    result, seconds = _timed(case)
    peak = _peak_mib()
    return {
        "case": name,
        "kernel_s": seconds,
        "naive_s": naive_seconds(case),
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
