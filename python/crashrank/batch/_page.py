"""The summary page: one HTML file without script that loads nothing. All texts are escaped."""

from __future__ import annotations

import html
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from .. import _core

if TYPE_CHECKING:
    from ._summary import Summary

_STYLE = """
:root{color-scheme:light dark}
body{font:16px/1.5 system-ui,sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem}
table{border-collapse:collapse;width:100%}
th,td{text-align:left;padding:.25rem .75rem .25rem 0;vertical-align:top}
tr{border-bottom:1px solid #8884}
td.n,th.n{text-align:right;font-variant-numeric:tabular-nums}
td{overflow-wrap:anywhere}
svg{width:100%;height:auto}
rect{fill:#b33}
text{font-size:11px;fill:currentColor}
.note{color:#b33;font-weight:600}
footer{margin-top:2rem;font-size:.85rem;opacity:.75;overflow-wrap:anywhere}
"""
_STEPS = (1.0, 2.0, 5.0)


def page(summary: Summary, outcome: dict[str, Any], reports: str, links: set[str]) -> str:
    """Return the page of a summary.

    Parameters
    ----------
    summary
        What is shown.
    outcome
        Members of the run's outcome.
    reports
        The folder of the reports, relative to the page.
    links
        Names of the reports that exist.
    """
    body = [_head(summary, outcome)]
    for measure in sorted(summary.scores):
        body.append(_distribution(measure, sorted(summary.scores[measure])))
    body.append(_worst(summary, reports, links))
    body.append(_failures(summary))
    footer = f"crashrank {_core.version}; results {outcome['results']}"
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width">'
        '<meta http-equiv="Content-Security-Policy" content="default-src \'none\'; '
        "style-src 'unsafe-inline'\"><title>crashrank: "
        f"{outcome['done_rows']} scenes</title><style>{_STYLE}</style></head>\n<body>"
        + "\n".join(body)
        + f"\n<footer>{_text(footer)}</footer></body></html>\n"
    )


def _text(value: object) -> str:
    return html.escape(str(value), quote=True)


def _head(summary: Summary, outcome: dict[str, Any]) -> str:
    failures = sum(summary.codes.values())
    lines = ["<h1>Least harmful crashes of many scenes</h1>"]
    if not outcome["complete"]:
        lines.append(
            f'<p class="note">Not complete: {outcome["done_rows"]} of {outcome["rows"]} scenes. '
            "The same command continues.</p>"
        )
    ranked = outcome["done_rows"] - failures
    lines.append(f"<p>{ranked} scenes ranked, {failures} with an error.")
    if summary.unscored:
        lines.append(f" Of {summary.unscored} the work budget left no score.")
    return "".join(lines) + "</p>"


def _distribution(measure: str, scores: Sequence[float]) -> str:
    """Return quantiles and a histogram of sorted scores."""
    named = [("median", 0.5), ("90 %", 0.9), ("99 %", 0.99), ("highest", 1.0)]
    cells = "".join(
        f'<td class="n">{_number(scores[min(len(scores) - 1, int(q * len(scores)))])}</td>'
        for _, q in named
    )
    heads = "".join(f'<th class="n">{name}</th>' for name, _ in named)
    return (
        f"<h2>Score of the best candidate: {_text(measure)}</h2>"
        f"{_histogram(bins(scores))}"
        f"<table><tr>{heads}</tr><tr>{cells}</tr></table>"
    )


def bins(scores: Sequence[float]) -> list[tuple[str, int]]:
    """Return names and sizes of bins: 0, then steps of 1, 2, 5 times powers of ten.

    At most four powers of ten below the highest score; what is lower shares the first bin.
    """
    highest = max(scores)
    if highest <= 0:
        return [("0", len(scores))]
    top = math.floor(math.log10(highest))
    edges = [step * 10.0**power for power in range(top - 3, top + 1) for step in _STEPS]
    edges = [edge for edge in edges if edge < highest]
    if not edges:
        edges = [highest]
    counts = [0] * (len(edges) + 2)
    for score in scores:
        counts[0 if score <= 0 else 1 + sum(score > edge for edge in edges)] += 1
    names = [
        "0",
        f"to {_number(edges[0])}",
        *(f"to {_number(edge)}" for edge in edges[1:]),
        f"to {_number(highest)}",
    ]
    return list(zip(names, counts, strict=True))


def _histogram(columns: Sequence[tuple[str, int]]) -> str:
    width, height, base = 760.0, 190.0, 150.0
    step = width / len(columns)
    most = max(count for _, count in columns)
    drawn = []
    for i, (name, count) in enumerate(columns):
        tall = 125.0 * count / most
        x = i * step
        drawn.append(
            f'<rect x="{x + 2:.1f}" y="{base - tall:.1f}" width="{step - 4:.1f}" '
            f'height="{tall:.1f}"><title>{_text(name)}: {count}</title></rect>'
            f'<text x="{x + step / 2:.1f}" y="{base - tall - 4:.1f}" text-anchor="middle">'
            f"{count or ''}</text>"
            f'<text x="{x + step / 2:.1f}" y="{base + 16:.1f}" text-anchor="middle">'
            f"{_text(name)}</text>"
        )
    return (
        f'<svg viewBox="0 0 {width:.0f} {height:.0f}" role="img" '
        f'aria-label="number of scenes by score">{"".join(drawn)}</svg>'
    )


def _worst(summary: Summary, reports: str, links: set[str]) -> str:
    rows = []
    for each in summary.worst():
        name = _text(each.id)
        if each.report in links:
            name = f'<a href="{_text(reports)}/{_text(each.report)}">{name}</a>'
        rows.append(
            f'<tr><td>{name}</td><td>{_text(each.best)}</td><td class="n">{_number(each.score)}'
            f"</td><td>{_text(each.measure)}</td></tr>"
        )
    if not rows:
        return ""
    return (
        "<h2>Worst scenes</h2><p>Even the best candidate scores high.</p><table>"
        '<tr><th>scene</th><th>best candidate</th><th class="n">score</th><th>measure</th></tr>'
        + "".join(rows)
        + "</table>"
    )


def _failures(summary: Summary) -> str:
    total = sum(summary.codes.values())
    if not total:
        return ""
    kinds = ", ".join(f"{_text(code)}: {count}" for code, count in summary.codes.most_common())
    rows = "".join(
        f"<tr><td>{_text(name)}</td><td>{_text(error)}</td></tr>"
        for name, error in summary.failures
    )
    shown = "" if total <= len(summary.failures) else f" The first {len(summary.failures)}:"
    return (
        f"<h2>Failures</h2><p>{kinds}.{shown}</p>"
        f"<table><tr><th>scene</th><th>error</th></tr>{rows}</table>"
    )


def _number(value: float) -> str:
    return f"{value:.3g}"
