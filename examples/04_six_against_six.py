# %% [markdown]
# # Six against six
#
# Two teams, a referee, twelve trees. The match is played tick by tick here, to tell every restart and goal
# as it happens; `robobt match six_v_six` plays it as well.

# %%
import robobt

SECONDS = 60.0

scenario = robobt.load_scenario("six_v_six").lasting(SECONDS)
command = None
with robobt.Match(scenario, seed=1, record="out/six_v_six.robobt.arrows") as match:  # closes the recording
    while match.tick():
        game = match.game
        if game.command is not command:
            command = game.command
            time = match.world.truth().time
            print(f"{time:6.2f} s  {game.blue_score}:{game.yellow_score}  {command.name}")

# %% [markdown]
# What every robot was doing at the end: the *tip* is the node that decided, and its feedback says why.

# %%
result = match.result()
print(f"{result.blue_score}:{result.yellow_score}, ball in play {result.in_play:.0%} of {result.time:.0f} s")
for player in match.players:
    tip = player.runner.root.tip()
    doing = "nothing" if tip is None else f"{tip.name}: {tip.feedback_message}"
    print(f"  {player.robot!s:9} {doing}")
match.world.truth()

# %% [markdown]
# `robobt show out/six_v_six.robobt.arrows` makes a page of it.
#
# ![Ten seconds of such a match](../images/six.gif)
