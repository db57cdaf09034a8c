"""Chapter on operator events."""

from collections.abc import Iterator

from controller.operator.actions import ACTIONS
from twin.manual.entry import Chapter, Entry, spelled


def events() -> Iterator[Entry]:
    """Everything that an operator can do."""
    for row in ACTIONS.values():
        name = row.action.value
        yield Entry(
            chapter=Chapter.EVENT,
            name=name,
            title=row.meaning,
            rows=(
                ("Form", row.form),
                ("Supported", f'yes: --event "3.0 {row.form}", or do = "{row.form}" in [[events]]'),
                ("Clause", "rulings, section 5"),
            ),
            names=frozenset({spelled(name), spelled(row.form)}),
        )
