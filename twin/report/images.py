"""Pictures inside the page."""

import base64


def data_url(png: bytes) -> str:
    """Return a PNG as the address of itself."""
    return "data:image/png;base64," + base64.b64encode(png).decode("ascii")
