"""`compensation.html`"""

from twin.compensation.walk import Compensation


def render(found: Compensation) -> str:
    """The page as HTML."""
    return f"<!doctype html><title>{found.job.name}</title>"
