"""What on a job's machine is not ideal: each of its faults, and what its drives cannot help."""

from dataclasses import dataclass, fields, replace

from twin.faults.table import Faults
from twin.machine import Drive, MachineSpec

IDEAL = Faults()
"""no fault at all"""
MISREADING = ("backlash", "encoder_counts", "encoder_cyclic_error")
"""what a drive cannot know of its axis, in the words of machine.toml"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Source:
    """Something that is not ideal."""

    name: str
    """as in the job or the parameter file"""
    words: str
    faults: Faults
    """with nothing but this"""
    drives: tuple[str, ...] | None = None
    """which of MISREADING the drives have beside their loops; None = axes that follow their setpoints"""
    against: str = ""
    """the source whose part it is compared with; empty = the ideal one"""


_FAULTS: tuple[tuple[str, tuple[str, ...], str], ...] = (
    ("work_eccentricity_mm", ("work_eccentricity_phase_deg",), "work clamped off centre"),
    ("work_tilt_deg", ("work_tilt_phase_deg",), "work clamped askew"),
    ("hob_runout_mm", ("hob_runout_angle_deg",), "hob off its spindle's axis"),
    ("hob_wobble_mm", ("hob_wobble_angle_deg",), "hob askew on its spindle"),
    ("hob_gash_error_deg", (), "spacing of the hob's gashes"),
    ("hob_lead_error_um_per_turn", (), "lead of the hob's thread"),
    ("swivel_error_deg", (), "swivel of the carrier"),
    ("encoder_cyclic_arcsec", ("encoder_cyclic_order",), "encoders, once or more a turn"),
    ("x_drift_um_per_min", (), "drift of X"),
    ("slide_tilt_deg", (), "way of the Z slide"),
)
"""key of [faults], what belongs to it, and what it is"""


def sources_of(faults: Faults, spec: MachineSpec, joints: tuple[str, ...]) -> tuple[Source, ...]:
    """All sources that a job and its machine have, faults first."""
    found = [
        Source(
            name=f"faults.{key}",
            words=words,
            faults=replace(IDEAL, **{name: getattr(faults, name) for name in (key, *beside)}),
        )
        for key, beside, words in _FAULTS
        if _amiss(getattr(faults, key))
    ]
    found.append(
        Source(name="drives", words="servo loops, friction and torque limits", faults=IDEAL, drives=())
    )
    given = [spec.drives[joint] for joint in joints]
    told = ("play of the transmissions", "steps of the encoders", "cyclic errors of the encoders")
    for key, words in zip(MISREADING, told, strict=True):
        if any(getattr(drive, key) for drive in given):
            found.append(
                Source(name=f"drives.{key}", words=words, faults=IDEAL, drives=(key,), against="drives")
            )
    return tuple(found)


def _amiss(value: object) -> bool:
    """Whether a fault is one: not nought, in whatever it is written."""
    if isinstance(value, dict):
        return any(value.values())
    if isinstance(value, tuple):
        return any(value)
    if isinstance(value, float):
        return value != 0.0
    return any(getattr(value, f.name) for f in fields(value))  # pyright: ignore[reportArgumentType]


def with_drives(spec: MachineSpec, kept: tuple[str, ...]) -> MachineSpec:
    """The machine without what its drives misread, but for `kept`."""
    gone = {key: 0.0 for key in MISREADING if key not in kept}
    drives: dict[str, Drive] = {joint: replace(drive, **gone) for joint, drive in spec.drives.items()}
    return replace(spec, drives=drives)
