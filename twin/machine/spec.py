"""What a machine is: `models/<name>/machine.toml` as frozen, checked values."""

import math
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from enum import Enum
from importlib.resources import files
from pathlib import Path
from typing import Any

from twin.errors import InputError, Place
from twin.machine.drive import Drive
from twin.machine.parameter_file import ParameterReader

MODELS = Path(str(files("models")))
PARAMETER_FILE = "machine.toml"


class Setup(Enum):
    """The lathe's set-ups (controller.md, section 0): which joints are axes, and in what order."""

    HOBBING = "hobbing"
    TILTED = "tilted"


@dataclass(frozen=True, slots=True, kw_only=True)
class Changes:
    """What a job changes of a parameter file, and where it says so."""

    table: Mapping[str, Any]
    """as the parameter file: `{"drives": {"x_slide": {"position_gain": 50.0}}}`"""
    place: Callable[[tuple[str, ...]], Place]
    """of a key in the job"""

    def holds(self, path: tuple[str, ...]) -> bool:
        """Whether the job says something about this key."""
        found: Any = self.table
        for key in path:
            if not isinstance(found, Mapping) or key not in found:
                return False
            found = found[key]
        return True


@dataclass(frozen=True, slots=True, kw_only=True)
class Mounts:
    """What carries tool and work, between the axes and the metal; the same in every direction [N/µm]."""

    tool_stiffness: float
    """of tool, arbor and carrier against the slide"""
    work_stiffness: float
    """of work, arbor and spindle against the bed, with a tailstock"""


@dataclass(frozen=True, slots=True, kw_only=True)
class MachineSpec:
    """A machine's parameter file."""

    name: str
    folder: Path
    """holds `<name>.xml`, `scene.xml` and the parameter file"""
    control_period_s: float
    physics_step_s: float
    """divides the control period"""
    setups: dict[Setup, tuple[str, ...]]
    """joint names in system axis order; joints not named are clamped"""
    drives: dict[str, Drive]
    """by joint name"""
    mounts: Mounts
    changes: Changes | None = None
    """what the job has changed"""

    @property
    def substeps(self) -> int:
        """Physics steps in one control period."""
        return round(self.control_period_s / self.physics_step_s)

    @property
    def place(self) -> Place:
        """The parameter file, for messages."""
        return Place(file=str(self.folder / PARAMETER_FILE))

    def place_of(self, *paths: tuple[str, ...]) -> Place:
        """Where the values that are at fault come from: the job where it changes one, else the parameter
        file."""
        for path in paths:
            if self.changes and self.changes.holds(path):
                return self.changes.place(path)
        return self.place


def load_machine(name: str, *, models: Path = MODELS, changes: Changes | None = None) -> MachineSpec:
    """Read `models/<name>/machine.toml`, with what a job changes of its drives and periods.

    Raises InputError for an unknown model, unreadable TOML, unknown or missing keys, wrong types and
    impossible values.
    """
    valid = sorted(p.parent.name for p in models.glob(f"*/{PARAMETER_FILE}"))
    if name not in valid:
        raise InputError(f"no machine model named {name!r}", remedy=f"valid: {', '.join(valid) or 'none'}")
    folder = models / name
    place = Place(file=str(folder / PARAMETER_FILE))
    try:
        table = tomllib.loads((folder / PARAMETER_FILE).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as cause:
        raise InputError(f"cannot read machine parameters: {cause}", place=place) from cause

    def place_of(path: tuple[str, ...]) -> Place:
        return changes.place(path) if changes and changes.holds(path) else place

    reader = ParameterReader(table, changes.table if changes else {}, place_of)
    reader.keys((), ("control_period_s", "physics_step_s", "setups", "drives", "mounts"))
    mounts = tuple(f.name for f in fields(Mounts))
    reader.keys(("mounts",), mounts)
    reader.keys(("setups",), tuple(s.value for s in Setup))
    spec = MachineSpec(
        name=name,
        folder=folder,
        control_period_s=reader.positive(("control_period_s",)),
        physics_step_s=reader.positive(("physics_step_s",)),
        setups={s: reader.joints(("setups", s.value)) for s in Setup},
        drives={joint: reader.drive(joint) for joint in reader.table(("drives",))},
        mounts=Mounts(**{name: reader.positive(("mounts", name)) for name in mounts}),
        changes=changes,
    )
    _require_whole_steps(spec)
    for setup, joints in spec.setups.items():
        if missing := [j for j in joints if j not in spec.drives]:
            raise InputError(
                f"set-up {setup.value!r} moves {missing[0]!r}, which has no drive",
                place=place,
                remedy=f"drives: {', '.join(spec.drives)}",
            )
    return spec


def _require_whole_steps(spec: MachineSpec) -> None:
    period, step = spec.control_period_s, spec.physics_step_s
    ratio = period / step
    place = spec.place_of(("control_period_s",), ("physics_step_s",))
    if spec.substeps < 1 or not math.isclose(ratio, spec.substeps, rel_tol=1e-9):
        raise InputError(
            f"control_period_s = {period} is {ratio:.6g} physics steps of {step} s",
            place=place,
            remedy="it must be a whole number of them",
        )
    rate = 1.0 / period
    if not math.isclose(rate, round(rate), rel_tol=1e-9):
        raise InputError(
            f"control_period_s = {period} divides a second into {rate:.6g} parts",
            place=place,
            remedy="a whole fraction of a second, as 0.001",
        )
