# %% [markdown]
# # Which team is better?
#
# Every pairing meets with the same seeds from either side, so that luck with the starts cancels out.
# `robobt tournament` does this over night, on all cores, and goes on where it was stopped; here are a few
# matches from Python.

# %%
import robobt
from robobt.tournament import Plan, play_tournament, read_entrant, standings_of

ROUNDS = 5
SECONDS = 20.0

plan = Plan(
    robobt.load_scenario("three_v_three").lasting(SECONDS),
    entrants=(read_entrant("team_player"), read_entrant("field_player")),
    rounds=ROUNDS,
    seed=1,
)
with plan.open_store("out/tutorial.sqlite") as store:
    found = standings_of(play_tournament(plan, store).matches, plan.names)

# %% [markdown]
# A rating is a strength on the Elo scale with its 95 % interval: where the intervals of two teams overlap
# widely, it takes more rounds. `robobt tournament run --sprt` plays as many as are needed, and no more.

# %%
for name, one in found.standings.items():
    rating = f"{one.rating.elo:+.0f} ({one.rating.low:+.0f} to {one.rating.high:+.0f})"
    print(f"{name:14} Elo {rating:22} {one.won} won, {one.drawn} drawn, {one.lost} lost")
for met in found.encounters:
    goals = f"{met.goals_for} : {met.goals_against} in {met.matches} matches"
    print(f"{met.first} v {met.second}: {goals}, p = {met.p:.2g}")

# %% [markdown]
# More: [tournaments](../tournament.md), [tuning a play's parameters](../sweep.md).
