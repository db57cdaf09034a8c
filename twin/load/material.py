"""What a material costs to cut: Kienzle's specific cutting force (geometry.md, section 6).

    F_c = k_c1.1 b h^(1 − m_c),   k_c = F_c / (b h) = k_c1.1 h^(−m_c)

b and h [mm] are the width and thickness of the chip before it is cut.
"""

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from msgspec import Meta
from numpy.typing import NDArray

from twin.errors import InputError

Floats = NDArray[np.float64]
Positive = Annotated[float, Meta(gt=0)]
Share = Annotated[float, Meta(ge=0, le=2)]

THINNEST = 1e-3
"""[mm] Thinner chips are taken to cost as much per volume as these: the edge's own radius is larger."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Material:
    """A row of the table."""

    k_c11: float
    """specific cutting force of a chip 1 mm × 1 mm [N/mm²]"""
    m_c: float
    """exponent by which thin chips cost more"""

    def specific_force(self, thickness: Floats) -> Floats:
        """k_c (n,) [N/mm² = mJ/mm³] of chips of `thickness` (n,) [mm]."""
        return self.k_c11 * np.maximum(thickness, THINNEST) ** -self.m_c

    def growth(self, thickness: Floats) -> Floats:
        """d ln F / d ln h (n,): by which power the force of a chip grows with its `thickness` (n,) [mm]."""
        return np.where(thickness > THINNEST, 1.0 - self.m_c, 1.0)


MATERIALS = {
    "16MnCr5": Material(k_c11=2100.0, m_c=0.26),
    "42CrMo4": Material(k_c11=2500.0, m_c=0.26),
    "C45": Material(k_c11=2220.0, m_c=0.14),
}
"""geometry.md, section 6"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Physics:
    """`[physics]` of a job."""

    cutting_load: bool = False
    """cutting forces act on drives and mounts"""
    k_c11: Positive | None = None
    """[N/mm²] in place of the material's"""
    m_c: Annotated[float, Meta(ge=0, lt=1)] | None = None
    """in place of the material's"""
    feed_force_ratio: Share = 0.4
    """F_f/F_c, along the tool's axis where the edge faces that way (0.3-0.5)"""
    passive_force_ratio: Share = 0.4
    """F_p/F_c, towards the tool's axis where the edge faces away from it (0.3-0.5)"""
    tool_stiffness_n_per_um: Positive | None = None
    """of tool, arbor and carrier against the slide, in place of the machine's"""
    work_stiffness_n_per_um: Positive | None = None
    """of work, arbor and spindle against the bed, in place of the machine's"""
    load_resolution_mm: Positive | None = None
    """distance of the rays on which metal is counted; None = a share of the tooth pitch or edge width"""


def material_of(name: str, physics: Physics) -> Material:
    """The material by its name, with what the job says in its place.

    Raises InputError for a name that is not in the table, unless the job gives both figures itself.
    """
    if physics.k_c11 is not None and physics.m_c is not None:
        return Material(k_c11=physics.k_c11, m_c=physics.m_c)
    row = MATERIALS.get(name)
    if row is None:
        raise InputError(
            f"no cutting forces are known of material {name!r}",
            remedy=f"valid: {', '.join(MATERIALS)}; or k_c11 and m_c in [physics]",
        )
    return Material(
        k_c11=row.k_c11 if physics.k_c11 is None else physics.k_c11,
        m_c=row.m_c if physics.m_c is None else physics.m_c,
    )
