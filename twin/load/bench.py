"""One job's metal and forces in some ticks of its run."""

import numpy as np
from numpy.typing import NDArray

from controller.clock import Feedback
from twin.cutting.field import DepthField
from twin.cutting.motion import CutterMotion
from twin.job.schema import Job
from twin.kinematics import cutter_motion
from twin.load.forces import Clock, Stiff, cutting_load
from twin.load.material import material_of
from twin.load.reach import may_meet
from twin.load.removal import Removal, pieces
from twin.load.search import Search
from twin.load.span import Span, span_of
from twin.load.stiffness import stiffness_of
from twin.load.stock import Lean, Stock
from twin.load.timeline import no_load
from twin.session import tool_in_place
from twin.setup import Ready

Floats = NDArray[np.float64]

MM_PER_UM = 1e-3


class Bench:
    """What of a job the forces need to know; tools by their numbers."""

    def __init__(self, job: Job, ready: Ready) -> None:
        """Raises InputError for a material without figures."""
        self.material = material_of(job.work.material, job.physics)
        self.blank = job.work.blank()
        self.tick_s = ready.spec.control_period_s
        self.stiffness = stiffness_of(job, ready)
        self.no_load = no_load(
            ready.tool_column, ready.tools[0].kinematics.axes, self.stiffness.compliance_um_per_n
        )
        self._physics, self._ready = job.physics, ready

    def whole(self, lean: Lean) -> Stock:
        """The blank before anything is cut, as rays that `lean`. Raises InputError for a resolution
        beyond the memory."""
        cutters = [tool.cutter for tool in self._ready.tools]
        return Stock.of(self.blank, cutters, self._physics.load_resolution_mm, lean=lean)

    def span(self, before: tuple[NDArray[np.int64], Floats], feedback: Feedback, first: int) -> Span:
        """Ticks from `first` on as the machine has gone through them, after the rows `before`."""
        return span_of(before, feedback.actual, first, self.no_load.spindle)

    def motion(self, tool: int, span: Span, give: Floats | None = None) -> CutterMotion:
        """Of a tool in a span, whose mounts `give` way (m, 3) [µm] at its rows."""
        mounted, _ = tool_in_place(self._ready, tool)
        pushed = None if give is None else give * MM_PER_UM
        time_s = np.asarray((span.tick + 1) * self.tick_s, dtype=np.float64)
        return cutter_motion(mounted.kinematics, time_s, span.actual, pushed)

    def search(self, stock: Stock) -> Search:
        """For the metal of a window."""
        return Search(stock, radius=self.blank.radius, tick_s=self.tick_s)

    def metal(self, search: Search, tool: int, motion: CutterMotion, span: Span) -> Removal:
        """What the tool takes off the stock in a span, and in the ticks next to it."""
        return search.metal(self._field(search.stock, tool, motion, span), motion, span)

    def first_cut(self, stock: Stock, tool: int, span: Span) -> int | None:
        """The first tick of a span in which metal is cut."""
        motion = self.motion(tool, span)
        field = self._field(stock, tool, motion, span)
        if field is None:
            return None
        for some, _ in pieces(stock, field, motion, span.between(self.tick_s)):
            if len(some.ray):
                return int(some.time_s.min() / self.tick_s)
        return None

    def forces(self, tool: int, metal: Removal, motion: CutterMotion, span: Span) -> Stiff:
        """That removing the metal puts on the machine."""
        mounted, _ = tool_in_place(self._ready, tool)
        angle = span.actual[:, self.no_load.spindle]
        return cutting_load(
            metal,
            motion,
            kinematics=mounted.kinematics,
            material=self.material,
            physics=self._physics,
            clock=Clock(tick_s=self.tick_s, tick=span.tick, tool_angle_deg=angle),
            compliance_um_per_n=self.stiffness.compliance_um_per_n,
            since=span.first,
        )

    def _field(self, stock: Stock, tool: int, motion: CutterMotion, span: Span) -> DepthField | None:
        mounted, cuts = tool_in_place(self._ready, tool)
        inside = np.flatnonzero((span.tick >= span.first - 2) & (span.tick <= span.last))
        rows = slice(int(inside[0]), int(inside[-1]) + 1)
        if not cuts or not may_meet(mounted.cutter, motion, stock, rows):
            return None
        return DepthField(mounted.cutter, motion, self.blank.radius, self.blank.z_range)
