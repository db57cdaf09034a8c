"""How stiff the mounts of tool and work are: the machine's figures, or the job's in their place.

The machine's figure for the work is that of an arbor with a tailstock. Without one the work stands free, a
beam of steel out of the chuck: k = 3 E I / L³, I = π d⁴/64. That is said, not taken, for a job that leaves
its arbor open has not chosen one either.
"""

import math
from dataclasses import dataclass

from twin.job.schema import Job
from twin.setup import Ready

STEEL = 210e3
"""E [N/mm²]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Stiffness:
    """[N/µm] the same in every direction."""

    tool: float
    """of tool, arbor and carrier against the slide"""
    work: float
    """of work, arbor and spindle against the bed"""
    free: float | None = None
    """of the work's arbor as a beam that stands free, where the job has no tailstock and names no figure of
    its own, and this is less"""

    @property
    def compliance_um_per_n(self) -> float:
        """Of both mounts together, springs in a row."""
        return 1.0 / self.tool + 1.0 / self.work

    def words(self) -> str:
        """In one line."""
        said = f"mounts of {self.tool:g} N/µm at the tool, {self.work:g} N/µm at the work"
        if self.free is None:
            return said
        return (
            f"{said}, as with a tailstock, which this job has not: free out of the chuck its work would have "
            f"{self.free:.2g} N/µm (valid: [setup] tailstock, or [physics] work_stiffness_n_per_um)"
        )


def stiffness_of(job: Job, ready: Ready) -> Stiffness:
    """Of a job on its machine."""
    own, mounts = job.physics, ready.spec.mounts
    tool = mounts.tool_stiffness if own.tool_stiffness_n_per_um is None else own.tool_stiffness_n_per_um
    if own.work_stiffness_n_per_um is not None:
        return Stiffness(tool=tool, work=own.work_stiffness_n_per_um)
    bar = job.work.diameter_mm if job.work.clamping == "chuck" else ready.work.arbor_diameter_mm
    free = beam(bar, ready.work.stick_out)
    stands_free = job.setup.tailstock is None and free < mounts.work_stiffness
    return Stiffness(tool=tool, work=mounts.work_stiffness, free=free if stands_free else None)


def beam(diameter_mm: float, length_mm: float) -> float:
    """Stiffness of a round bar of steel at its free end, the other one clamped [N/µm]."""
    return 3.0 * STEEL * math.pi * diameter_mm**4 / 64.0 / length_mm**3 * 1e-3
