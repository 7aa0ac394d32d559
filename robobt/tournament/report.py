"""A tournament as one HTML page that needs nothing else but the recorded matches it links to."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from pathlib import Path
from urllib.parse import quote

from robobt.config.atomic import write_atomically
from robobt.config.wording import counted
from robobt.live.replay_html import write_html
from robobt.match.recording import RecordingError
from robobt.tournament.played import PlayedMatch
from robobt.tournament.recordings import Recordings
from robobt.tournament.standings import Standing, Standings

_REPORT_STYLE = """
:root { color-scheme: light dark; font: 15px/1.5 system-ui, sans-serif }
body { max-width: 70rem; margin: 2rem auto; padding: 0 1rem }
table { border-collapse: collapse; margin: 0.5rem 0 1.5rem }
th, td { padding: 0.15rem 0.8rem 0.15rem 0; text-align: right; font-variant-numeric: tabular-nums }
th:first-child, td:first-child { text-align: left }
tr { border-bottom: 1px solid color-mix(in srgb, currentColor 20%, transparent) }
svg { font: 13px system-ui, sans-serif; fill: currentColor; stroke: currentColor; max-width: 100% }
svg text { stroke: none }
"""

_PLOT_WIDTH, _NAMES_WIDTH, _PLOT_ROW_HEIGHT = 760.0, 260.0, 28.0
"""Of the rating plot: its width, where the names end, and the height of a row [pixels]."""

_FIGURE_COLUMNS = {
    "goals": "goals",
    "expected_goals": "expected goals",
    "shots_on_goal": "shots on goal",
    "passes": "passes",
    "passes_completed": "completed",
    "fouls": "fouls",
    "yellow_cards": "yellow cards",
    "red_cards": "red cards",
}


def write_report(
    path: Path,
    played: Mapping[str, object],
    found: Standings,
    matches: Sequence[PlayedMatch],
    recordings: Recordings | None = None,
    verdict: str | None = None,
) -> None:
    """Write the page, and those of the recorded matches that it links to.

    Args:
        path: the page.
        played: what was played, by field.
        found: what the tournament says.
        matches: its matches.
        recordings: where recordings are; None without them.
        verdict: what a sequential test says; None without one.

    Raises:
        OSError: a page cannot be written.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    links = {} if recordings is None else _pages(recordings, matches, path.parent)
    write_atomically(path, report(played, found, matches, links, verdict))


def report(
    played: Mapping[str, object],
    found: Standings,
    matches: Sequence[PlayedMatch],
    links: Mapping[object, str],
    verdict: str | None = None,
) -> str:
    """Return the page; ``links`` are addresses of recorded matches by their fixtures."""
    title = escape(f"Tournament: {played.get('scenario', '')}")
    settings = ", ".join([f"{escape(str(name))} {escape(str(value))}" for name, value in played.items()])
    parts = [
        f"<h1>{title}</h1><p>{settings}; {counted(found.matches, 'match', 'matches')}, "
        f"{found.distinct} of them distinct.</p>",
        f"<p><b>{escape(verdict)}</b></p>" if verdict else "",
        "<h2>Ratings</h2>",
        rating_plot(found.standings),
        _table(_STANDING_HEAD, [_standing_row(name, one) for name, one in found.standings.items()]),
        "".join([f"<p>{escape(remark)}</p>" for remark in found.remarks()]),
        "<h2>Won, drawn, lost of the row against the column</h2>",
        _cross_table(found),
        "<h2>Encounters</h2>",
        _table(_ENCOUNTER_HEAD, _encounter_rows(found)),
        "<h2>A match in the mean</h2>",
        _table(
            ["", *_FIGURE_COLUMNS.values()], [_figure_row(name, one) for name, one in found.standings.items()]
        ),
        _recorded(matches, links),
    ]
    head = f'<meta charset="utf-8"><title>{title}</title><style>{_REPORT_STYLE}</style>'
    return f"<!doctype html><html lang=en><head>{head}</head><body>{''.join(parts)}</body></html>\n"


def rating_plot(standings: Mapping[str, Standing]) -> str:
    """Return the ratings with their intervals as a picture (SVG)."""
    low = min(one.rating.low for one in standings.values())
    high = max(one.rating.high for one in standings.values())
    scale = (_PLOT_WIDTH - _NAMES_WIDTH - 20.0) / max(high - low, 1.0)

    def at(elo: float) -> float:
        return _NAMES_WIDTH + 10.0 + (elo - low) * scale

    bottom = _PLOT_ROW_HEIGHT * len(standings)
    drawn = [f'<line x1="{at(0):.1f}" x2="{at(0):.1f}" y1="0" y2="{bottom:.0f}" stroke-dasharray="3" />']
    for number, (name, one) in enumerate(standings.items()):
        y, rating = _PLOT_ROW_HEIGHT * (number + 0.5), one.rating
        shown = name if len(name) <= 34 else f"{name[:33]}…"
        drawn.append(
            f'<text x="{_NAMES_WIDTH:.0f}" y="{y + 4:.0f}" text-anchor="end">{escape(shown)}'
            f"<title>{escape(name)}</title></text>"
            f'<line x1="{at(rating.low):.1f}" x2="{at(rating.high):.1f}" y1="{y:.0f}" y2="{y:.0f}" />'
            f'<circle cx="{at(rating.elo):.1f}" cy="{y:.0f}" r="4"><title>{_elo(one)}</title></circle>'
        )
    for elo, anchor in ((low, "start"), (high, "end")):
        drawn.append(
            f'<text x="{at(elo):.1f}" y="{bottom + 16:.0f}" text-anchor="{anchor}">{elo:+.0f}</text>'
        )
    size = f'width="{_PLOT_WIDTH:.0f}" height="{bottom + 24:.0f}"'
    return f'<svg {size} role="img" aria-label="Ratings with 95 % intervals">{"".join(drawn)}</svg>'


def _pages(recordings: Recordings, matches: Iterable[PlayedMatch], folder: Path) -> dict[object, str]:
    """Write the pages of recorded matches; return their addresses as seen from a folder."""
    found: dict[object, str] = {}
    for match in matches:
        recording, page = recordings.path(match.fixture), recordings.page(match.fixture)
        if not recording.is_file():
            continue
        if not page.is_file():
            try:
                write_html(recording, page)
            except RecordingError:
                # A match that ended with its process may have left no more than a beginning.
                continue
        found[match.fixture] = quote(Path(os.path.relpath(page, folder)).as_posix())
    return found


_STANDING_HEAD = ["entrant", "Elo (95 %)", "matches", "won", "drawn", "lost", "forfeits", "goals"]
_ENCOUNTER_HEAD = ["", "won-drawn-lost", "goals", "lead a match (95 %)", "rounds ahead", "p", "Holm's p"]


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table; what the rows hold is HTML already."""
    top = "".join([f"<th>{escape(cell)}</th>" for cell in head])
    body = "".join([f"<tr>{''.join([f'<td>{cell}</td>' for cell in row])}</tr>" for row in rows])
    return f"<table><tr>{top}</tr>{body}</table>"


def _standing_row(name: str, one: Standing) -> list[str]:
    counts = [one.matches, one.won, one.drawn, one.lost, one.forfeits]
    goals = f"{one.goals_for} : {one.goals_against}"
    return [escape(name), _elo(one), *map(str, counts), goals]


def _elo(one: Standing) -> str:
    return f"{round(one.rating.elo):+d} ({round(one.rating.low):+d} to {round(one.rating.high):+d})"


def _cross_table(found: Standings) -> str:
    cells = {}
    for one in found.encounters:
        cells[one.first, one.second] = f"{one.won}-{one.drawn}-{one.lost}"
        cells[one.second, one.first] = f"{one.lost}-{one.drawn}-{one.won}"
    names = list(found.standings)
    rows = [[escape(name), *[cells.get((name, other), "") for other in names]] for name in names]
    return _table(["", *names], rows)


def _encounter_rows(found: Standings) -> Iterable[list[str]]:
    for one in found.encounters:
        lead = "-" if one.lead is None else f"{one.lead:+.2f}"
        if one.low is not None:
            lead += f" ({one.low:+.2f} to {one.high:+.2f})"
        yield [
            escape(f"{one.first} v {one.second}"),
            f"{one.won}-{one.drawn}-{one.lost}",
            f"{one.goals_for} : {one.goals_against}",
            lead,
            f"{one.rounds_won} : {one.rounds_lost}",
            f"{one.p:.2g}",
            f"{one.holm:.2g}",
        ]


def _figure_row(name: str, one: Standing) -> list[str]:
    return [escape(name), *[f"{one.figures[figure]:.2f}" for figure in _FIGURE_COLUMNS]]


def _recorded(matches: Iterable[PlayedMatch], links: Mapping[object, str]) -> str:
    rows = [
        [
            f'<a href="{escape(links[match.fixture])}">{escape(f"{match.blue} v {match.yellow}")}</a>',
            str(match.round),
            f"{match.blue_score} : {match.yellow_score}",
            escape(match.outcome.replace("_", " ")),
        ]
        for match in matches
        if match.fixture in links
    ]
    if not rows:
        return ""
    return f"<h2>Recorded matches</h2>{_table(['blue v yellow', 'round', 'goals', 'end'], rows)}"
