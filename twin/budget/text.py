"""A budget in words and rows."""

from twin.budget.draw_up import Budget, Share, Values
from twin.budget.items import ITEMS

WIDE = 62
"""characters of the column of sources"""


def lines(budget: Budget) -> list[str]:
    """What the terminal says: a table in µm, a row for each source, and what to mend first."""
    head = " " * WIDE + "".join(f"{item.symbol:>8}" for item in ITEMS)
    rows = [head, _row("left by the process itself", budget.ideal)]
    rows += [_share(share) for share in budget.shares]
    rows.append(_share(budget.together))
    if budget.tolerances:
        rows.append(_row(f"allowed in class {budget.accuracy_class}", dict(budget.tolerances)))
    return ["µm, the largest of both flanks of the teeth traced", *rows, *advice(budget)]


def advice(budget: Budget) -> list[str]:
    """What to mend first, in sentences."""
    if not budget.shares:
        return []
    first = budget.shares[0]
    if first.reason:
        return [f"mend first: {first.words} ({first.name}): it leaves no gear: {first.reason}"]
    key, weight = budget.worst(first)
    item = next((item for item in ITEMS if item.key == key), None)
    value = first.values.get(key)
    if item is None or value is None or weight == 0.0:
        return ["nothing on this machine shows on the part"]
    said = f"mend first: {first.words} ({first.name}): {abs(value):.1f} µm of {item.words} {item.symbol}"
    if budget.tolerances:
        said += f", {100 * weight:.0f} % of what class {budget.accuracy_class} allows"
    return [said]


def _share(share: Share) -> str:
    name = f"{share.words} ({share.name})" if share.name != "together" else share.words
    return f"{name:<{WIDE}}  {share.reason}" if share.reason else _row(name, share.values)


def _row(name: str, values: Values) -> str:
    shown = "".join("       —" if (v := values.get(i.key)) is None else f"{v:8.2f}" for i in ITEMS)
    return f"{name:<{WIDE}}{shown}"
