"""The points of all traces as comma-separated values, for whoever wants to draw or evaluate them anew."""

from collections.abc import Iterator

from twin.inspection.result import GearResult

HEADER = "flank,trace,tooth,position_mm,deviation_um,evaluated"


def csv_lines(gear: GearResult) -> Iterator[str]:
    """Yield a header, then a line a point: roll length or z [mm], deviation [µm], evaluated or not."""
    yield HEADER
    for side in ("left", "right"):
        flank = getattr(gear, side)
        for name in ("profile", "helix"):
            for trace in getattr(flank, name):
                low, high = trace.evaluation
                for at, value in zip(trace.position.tolist(), trace.deviation_um.tolist(), strict=True):
                    inside = int(low <= at <= high)
                    yield f"{side},{name},{trace.tooth},{at:.6f},{value:.6f},{inside}"
