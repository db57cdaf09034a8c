"""`budget.html`: one page that opens offline. A bar for each source, and what it does to every item."""

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup, escape

from twin.budget.draw_up import Budget, Share, Values
from twin.budget.text import advice

LEFT, BAR, ROW = 330.0, 420.0, 30.0
"""[px] of the picture: names, longest bar, height of a row"""


def render(budget: Budget) -> str:
    """The page as HTML."""
    rows = [
        *(_row(budget, share) for share in budget.shares),
        _row(budget, budget.together, css="total"),
    ]
    return _ENVIRONMENT.get_template("budget.html").render(
        title=budget.title,
        accuracy_class=budget.accuracy_class,
        graded=bool(budget.tolerances),
        items=[{"symbol": _lowered(item.symbol), "words": item.words} for item in budget.items],
        process=_cells(budget, budget.ideal),
        rows=rows,
        allowed=[_number(budget.tolerances.get(item.key)) for item in budget.items],
        of_gear=budget.of_gear,
        advice=[_sentence(said, budget) for said in advice(budget)],
        picture=_picture(budget),
    )


def _row(budget: Budget, share: Share, css: str = "") -> dict[str, object]:
    return {
        "words": share.words,
        "name": share.name,
        "css": css,
        "reason": share.reason,
        "cells": _cells(budget, share.values),
    }


def _cells(budget: Budget, values: Values) -> list[dict[str, object]]:
    """Figure and shade (0 to 100) of every item; shaded where something is allowed and used up."""
    return [
        {
            "text": _number(values.get(item.key)),
            "shade": round(min(budget.weight(item.key, values.get(item.key)), 1.0) * 100)
            if item.key in budget.tolerances
            else 0,
        }
        for item in budget.items
    ]


def _number(value: float | None) -> str:
    if value is None:
        return "—"
    return (f"{value:.2f}" if abs(value) < 10 else f"{value:.1f}").replace("-", "−")


def _lowered(symbol: str) -> Markup:
    """The part behind `_` stands lower."""
    head, _, low = symbol.partition("_")
    return Markup(f"{escape(head)}<sub>{escape(low)}</sub>") if low else Markup(escape(head))


def _sentence(said: str, budget: Budget) -> Markup:
    """A sentence with a capital letter, a full stop, and the symbols in it set."""
    text = str(escape(f"{said[0].upper()}{said[1:]}."))
    for item in budget.items:
        text = text.replace(f" {item.symbol},", f" {_lowered(item.symbol)},")
        text = text.replace(f" {item.symbol}.", f" {_lowered(item.symbol)}.")
    return Markup(text)


def _picture(budget: Budget) -> Markup:
    """Bars of the sources' worst items, as drawn on one scale."""
    worst = [budget.worst(share) for share in budget.shares]
    longest = max([weight for _, weight in worst] + ([1.0] if budget.tolerances else [0.0])) or 1.0
    height = ROW * (len(worst) + 1)
    symbols = {item.key: item.symbol for item in budget.items}
    parts: list[str] = []
    for k, (share, (item, weight)) in enumerate(zip(budget.shares, worst, strict=True)):
        y = k * ROW
        length = BAR * (1.0 if share.reason else weight / longest)
        figure = "no part" if share.reason else _figure(budget, share, item, weight, symbols.get(item, ""))
        parts.append(f'<text x="{LEFT - 10:g}" y="{y + 19:g}" class="name">{escape(share.words)}</text>')
        css = "bar lost" if share.reason else "bar"
        parts.append(
            f'<rect x="{LEFT:g}" y="{y + 6:g}" width="{max(length, 1.0):.1f}" height="18" class="{css}"/>'
        )
        parts.append(f'<text x="{LEFT + max(length, 1.0) + 8:.1f}" y="{y + 19:g}">{figure}</text>')
    if budget.tolerances:
        x = LEFT + BAR / longest
        parts.append(
            f'<line x1="{x:.1f}" y1="0" x2="{x:.1f}" y2="{height - ROW + 4:g}" class="limit"/>'
            f'<text x="{x:.1f}" y="{height - 8:g}" class="middle">all that class '
            f"{budget.accuracy_class} allows</text>"
        )
    return Markup(
        f'<svg viewBox="0 0 1000 {height:g}" role="img" aria-label="the worst item of every source">'
        f"{''.join(parts)}</svg>"
    )


def _figure(budget: Budget, share: Share, item: str, weight: float, symbol: str) -> str:
    value = share.values.get(item)
    if value is None or not symbol:
        return "nothing"
    head, _, low = symbol.partition("_")
    said = f'{head}<tspan dy="3" font-size="11">{low}</tspan><tspan dy="-3"> {abs(value):.2f} µm</tspan>'
    return f"{said}, {100 * weight:.0f} %" if budget.tolerances else said


_ENVIRONMENT = Environment(
    loader=PackageLoader("twin.budget", "assets"), autoescape=True, undefined=StrictUndefined
)
