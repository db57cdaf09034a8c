"""job.toml -> frozen dataclasses, or a message that names the line and what would be valid."""

from twin.job.read import read_job
from twin.job.schema import Job

__all__ = ["Job", "read_job"]
