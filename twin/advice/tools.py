"""Does the tool fit the program: is there one, and is it made for the gear box?"""

from collections.abc import Iterator

from controller.commands import SelectTool
from controller.laws.gearbox import SyncKind
from controller.observed import Observed
from twin.advice.advice import Advice
from twin.advice.kinds import Kind
from twin.advice.moment import Engagement
from twin.advice.scene import Scene
from twin.cutters.hob import Hob
from twin.inspection.nominal import GearNominal


def judge_call(scene: Scene, seen: Observed) -> Iterator[Advice]:
    """Advice on a T word that calls what the job does not have."""
    probe = scene.job.probe
    if not isinstance(seen.command, SelectTool) or (probe and seen.command.number == probe.tool):
        return
    if scene.tool(seen.command.number) is None:
        valid = ", ".join(f"T{number:02d}" for number in scene.tools)
        found = f"T{seen.command.number:02d}"
        yield Advice(kind=Kind.UNKNOWN_TOOL, found=found, span=seen.span, valid=f"{valid} of the job")


def judge_tool(scene: Scene, engagement: Engagement) -> Iterator[Advice]:
    """Advice on a hob in polygon turning, a polygon head while hobbing, and either for the other's part."""
    kind, nominal = engagement.gear.kind, scene.job.nominal
    hobbing, hob = kind is SyncKind.HOBBING, isinstance(engagement.mounted.tool, Hob)
    if hob is not hobbing:
        found = f"{kind.value} with {'a hob' if hob else 'a polygon head'}"
        yield Advice(kind=Kind.TOOL, found=found, span=engagement.span)
    elif nominal is not None and isinstance(nominal, GearNominal) is not hobbing:
        wanted = "polygon" if hobbing else "gear"
        found = f"{kind.value}, where the nominal is a {wanted}"
        yield Advice(kind=Kind.TOOL, found=found, span=engagement.span)
