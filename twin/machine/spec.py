"""What a machine's drives are: `models/<name>/machine.toml` as frozen, checked values."""

import math
import tomllib
from dataclasses import dataclass, fields
from enum import Enum
from importlib.resources import files
from pathlib import Path
from typing import Any

from twin.errors import InputError, Place

MODELS = Path(str(files("models")))
PARAMETER_FILE = "machine.toml"


class Setup(Enum):
    """The lathe's set-ups (controller.md, section 0): which joints are axes, and in what order."""

    HOBBING = "hobbing"
    TILTED = "tilted"


@dataclass(frozen=True, slots=True, kw_only=True)
class Drive:
    """One servo drive with its transmission, referred to the joint: [kg, N, m] or [kg m², N m, rad]."""

    drive_inertia: float
    """[kg | kg m²] of motor and transmission, besides the bodies they move"""
    coulomb_friction: float
    """[N | N m]"""
    viscous_friction: float
    """[N s/m | N m s]"""
    force_limit: float
    """[N | N m]"""
    position_gain: float
    """Kv [1/s]"""
    velocity_feedforward: float
    """k_ff; the lag at constant speed v is (1 - k_ff) v / Kv"""
    acceleration_feedforward: float
    """share of the force of acceleration that is given ahead of the loops"""
    velocity_gain: float
    """proportional gain of the velocity loop over the moved inertia [1/s]"""
    integral_time_s: float
    """reset time of the velocity loop"""
    in_position: float
    """following error below which the axis counts as in position [mm | deg]"""
    error_limit: float
    """following error above which the drive gives an alarm [mm | deg]"""


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

    @property
    def substeps(self) -> int:
        """Physics steps in one control period."""
        return round(self.control_period_s / self.physics_step_s)

    @property
    def place(self) -> Place:
        """The parameter file, for messages."""
        return Place(file=str(self.folder / PARAMETER_FILE))


def load_machine(name: str, *, models: Path = MODELS) -> MachineSpec:
    """Read `models/<name>/machine.toml`.

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
    reader = _Reader(place)
    reader.keys(table, ("control_period_s", "physics_step_s", "setups", "drives"), "machine")
    spec = MachineSpec(
        name=name,
        folder=folder,
        control_period_s=reader.positive(table, "control_period_s"),
        physics_step_s=reader.positive(table, "physics_step_s"),
        setups=reader.setups(table["setups"]),
        drives={
            joint: reader.drive(d, joint) for joint, d in reader.table(table["drives"], "drives").items()
        },
    )
    ratio = spec.control_period_s / spec.physics_step_s
    if spec.substeps < 1 or not math.isclose(ratio, spec.substeps, rel_tol=1e-9):
        raise InputError(
            f"control_period_s = {spec.control_period_s} is {ratio:.6g} physics steps of "
            f"{spec.physics_step_s} s",
            place=place,
            remedy="it must be a whole number of them",
        )
    for setup, joints in spec.setups.items():
        if missing := [j for j in joints if j not in spec.drives]:
            raise InputError(
                f"set-up {setup.value!r} moves {missing[0]!r}, which has no drive",
                place=place,
                remedy=f"drives: {', '.join(spec.drives)}",
            )
    return spec


_MAY_BE_ZERO = (
    "drive_inertia",
    "coulomb_friction",
    "viscous_friction",
    "velocity_feedforward",
    "acceleration_feedforward",
)


class _Reader:
    """Takes checked values out of parsed TOML; every message names the file and the key."""

    def __init__(self, place: Place) -> None:
        self._place = place

    def _fail(self, text: str, remedy: str = "") -> InputError:
        return InputError(text, place=self._place, remedy=remedy)

    def table(self, value: Any, where: str) -> dict[str, Any]:
        if not isinstance(value, dict):
            raise self._fail(f"{where}: expected a table, got {value!r}")
        return value

    def keys(self, table: dict[str, Any], expected: tuple[str, ...], where: str) -> None:
        for key in table:
            if key not in expected:
                raise self._fail(f"{where}: unknown key {key!r}", f"valid: {', '.join(expected)}")
        for key in expected:
            if key not in table:
                raise self._fail(f"{where}: key {key!r} is missing")

    def number(self, table: dict[str, Any], key: str, where: str = "machine") -> float:
        value = table[key]
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            raise self._fail(f"{where}: {key} = {value!r}: expected a finite number")
        if value < 0:
            raise self._fail(f"{where}: {key} = {value} must not be negative")
        return float(value)

    def positive(self, table: dict[str, Any], key: str, where: str = "machine") -> float:
        if (value := self.number(table, key, where)) == 0:
            raise self._fail(f"{where}: {key} = 0: must be above 0")
        return value

    def setups(self, value: Any) -> dict[Setup, tuple[str, ...]]:
        table = self.table(value, "setups")
        self.keys(table, tuple(s.value for s in Setup), "setups")
        for name, joints in table.items():
            if not isinstance(joints, list) or not all(isinstance(j, str) for j in joints):
                raise self._fail(f"setups.{name}: expected a list of joint names, got {joints!r}")
            if len(set(joints)) != len(joints):
                raise self._fail(f"setups.{name}: a joint is named twice: {joints}")
        return {s: tuple(table[s.value]) for s in Setup}

    def drive(self, value: Any, joint: str) -> Drive:
        table = self.table(value, f"drives.{joint}")
        names = tuple(f.name for f in fields(Drive))
        self.keys(table, names, f"drives.{joint}")
        where = f"drives.{joint}"
        return Drive(
            **{n: (self.number if n in _MAY_BE_ZERO else self.positive)(table, n, where) for n in names}
        )
