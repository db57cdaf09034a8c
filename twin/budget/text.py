"""A budget in words and rows."""

from twin.budget.draw_up import Budget, Share, Values
from twin.budget.items import Item

WIDE = 62
"""characters of the column of sources"""
LITTLE, LITTLE_UM = 0.05, 0.5
"""of what is allowed, or in µm where nothing is: what no source below it is mended for"""


def lines(budget: Budget) -> list[str]:
    """What the terminal says: a table in µm, a row for each source, and what to mend first."""
    items = budget.items
    head = " " * WIDE + "".join(f"{item.symbol:>8}" for item in items)
    rows = [head, _row("left by the process itself", budget.ideal, items)]
    rows += [_share(share, items) for share in budget.shares]
    rows.append(_share(budget.together, items))
    if budget.tolerances:
        rows.append(_row(f"allowed in class {budget.accuracy_class}", dict(budget.tolerances), items))
    felt = "both flanks of the teeth traced" if budget.of_gear else "all faces"
    return [f"µm, the largest of {felt}", *rows, *advice(budget)]


def advice(budget: Budget) -> list[str]:
    """What to mend first, in sentences."""
    if not budget.shares:
        return []
    first = budget.shares[0]
    if first.reason:
        return [f"mend first: {first.words} ({first.name}): it leaves no part: {first.reason}"]
    key, weight = budget.worst(first)
    item = next((item for item in budget.items if item.key == key), None)
    value = first.values.get(key)
    if item is None or value is None or weight == 0.0:
        return ["nothing on this machine shows on the part"]
    little = weight < (LITTLE if budget.tolerances else LITTLE_UM)
    most = "no source matters; the most comes from the" if little else "mend first:"
    said = f"{most} {first.words} ({first.name}): {abs(value):.1f} µm of {item.words} {item.symbol}"
    if budget.tolerances:
        said += f", {100 * weight:.0f} % of what class {budget.accuracy_class} allows"
    return [said]


def _share(share: Share, items: tuple[Item, ...]) -> str:
    name = f"{share.words} ({share.name})" if share.name != "together" else share.words
    return f"{name:<{WIDE}}  {share.reason}" if share.reason else _row(name, share.values, items)


def _row(name: str, values: Values, items: tuple[Item, ...]) -> str:
    shown = "".join("       —" if (v := values.get(i.key)) is None else f"{v:8.2f}" for i in items)
    return f"{name:<{WIDE}}{shown}"
