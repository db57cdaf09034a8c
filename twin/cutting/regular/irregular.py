"""Why a cut is handed over to the general way."""


class IrregularError(Exception):
    """The cut is not proved to be that of a complete regular gear; the message says what is missing."""
