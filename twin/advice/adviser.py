"""The rules beside a dry run: told every command, they say what is wrong before metal is cut."""

from collections.abc import Callable, Iterable, Iterator

from controller.commands import Couple, ProgramEnd, SelectTool, Uncouple
from controller.observed import Observed
from twin.advice.advice import Advice
from twin.advice.changes import judge_change
from twin.advice.finish import judge_gear_end, judge_marks
from twin.advice.gear import judge_gear_box
from twin.advice.hob_data import judge_hob
from twin.advice.kinds import Kind
from twin.advice.moment import Engagement, Moment
from twin.advice.paths import path_of
from twin.advice.polygon import judge_polygon_box, judge_polygon_end
from twin.advice.scene import Scene
from twin.advice.stock import Stock
from twin.advice.tools import judge_call, judge_tool
from twin.advice.way import judge_way

_ENGAGEMENT: tuple[Callable[[Scene, Engagement], Iterator[Advice]], ...] = (
    judge_tool,
    judge_hob,
    judge_gear_box,
    judge_polygon_box,
)
_MOMENT: tuple[Callable[[Moment], Iterator[Advice]], ...] = (judge_change, judge_way)
_END: tuple[Callable[[Scene, Engagement | None, Stock], Iterator[Advice]], ...] = (
    judge_gear_end,
    judge_marks,
    judge_polygon_end,
)


class Adviser:
    """Collects advice: `see` every command of a dry run, then `close`."""

    def __init__(self, scene: Scene) -> None:
        work = scene.job.work
        self._scene = scene
        self._stock = Stock.of_blank(diameter=work.diameter_mm, length=work.length_mm)
        self._tool = 0
        self._found: dict[tuple[Kind, str], Advice] = {}
        self._engaged: Engagement | None = None
        self._cut_with: Engagement | None = None
        """the last gear box that has cut"""
        self._judged = True
        """whether the rules have seen `_engaged`"""
        self._ended = False
        """whether the program has come to its end"""

    def see(self, seen: Observed) -> None:
        """One command of the program."""
        if isinstance(seen.command, SelectTool):
            self._tool = seen.command.number
            self._keep(judge_call(self._scene, seen))
        self._ended = isinstance(seen.command, ProgramEnd)
        mounted = self._scene.tool(self._tool)
        if mounted is None:
            return
        path = path_of(self._scene, seen, mounted.envelope)
        reach = self._stock.reach(mounted.envelope, path)
        moment = Moment(
            seen=seen,
            mounted=mounted,
            reach=reach,
            cut_depth=self._stock.depth_into(reach),
            blank_depth=self._stock.depth_into_blank(reach),
        )
        for rule in _MOMENT:
            self._keep(rule(moment))
        if moment.moves and moment.cut_depth:
            self._cut(moment)
        if isinstance(seen.command, Couple):
            # a gear box that is engaged anew before it has cut anything is not judged
            self._engaged = Engagement(couple=seen.command, span=seen.span, mounted=mounted)
            self._judged = False
        elif isinstance(seen.command, Uncouple):
            self._judge()

    def close(self) -> tuple[Advice, ...]:
        """All that was found; what the whole program should have done only if it came to its end."""
        self._judge()
        if self._ended:
            for rule in _END:
                self._keep(rule(self._scene, self._cut_with or self._engaged, self._stock))
        return tuple(sorted(self._found.values(), key=_order))

    def _cut(self, moment: Moment) -> None:
        if moment.gear:
            self._judge()
            self._cut_with = self._engaged
        self._stock.remove(moment.reach, feed=_axial_feed(self._scene, moment), span=moment.seen.span)

    def _judge(self) -> None:
        if self._engaged and not self._judged:
            self._judged = True
            for rule in _ENGAGEMENT:
                self._keep(rule(self._scene, self._engaged))

    def _keep(self, advice: Iterable[Advice]) -> None:
        """The first of its kind at each place: a subprogram that is run again says nothing new."""
        for one in advice:
            self._found.setdefault((one.kind, str(one.span)), one)


def _order(advice: Advice) -> tuple[bool, int, str]:
    span = advice.span
    return span is None, (span.line or 0) if span else 0, advice.number


def _axial_feed(scene: Scene, moment: Moment) -> float:
    """Feed along the work axis per turn of the work [mm]; 0 where that means nothing."""
    feed, before, after = moment.feed, moment.seen.slides_before, moment.seen.slides_after
    if feed is None or scene.z_column is None:
        return 0.0
    travel = [after[k] - before[k] for k, axis in enumerate(scene.machine.axes) if not axis.rotary]
    length = sum(one * one for one in travel) ** 0.5
    if length == 0.0:
        return 0.0
    share = abs(after[scene.z_column] - before[scene.z_column]) / length
    if feed.per_revolution:
        return share * feed.value
    return share * feed.value * 60.0 / moment.work_rpm if moment.work_rpm else 0.0
