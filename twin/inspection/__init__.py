"""Mesh in, deviations out. Uses neither the controller nor the machine: any mesh will do."""

from twin.inspection.deviation import deviation_map
from twin.inspection.inspection import inspect
from twin.inspection.sheet import to_json

__all__ = ["deviation_map", "inspect", "to_json"]
