"""Names of scenarios, plays and models that have changed, and what they are now."""

RENAMED = {
    "striker_vs_goalie": "striker_vs_goalkeeper",
    "keeper": "refereed_goalkeeper",
    "team_keeper": "team_goalkeeper",
    "keeper_2026_11": "goalkeeper_2026_11",
    "shot_expected_strong": "shot_expected",
}
