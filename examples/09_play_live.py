# %% [markdown]
# # Watch and steer a match live
#
# The match is played at its own pace and streamed to a page in the browser: open the address that is
# printed. There it can be paused, slowed down and steered; robots and ball can be dragged. `robobt match
# six_v_six --live` does the same.

# %%
import robobt
from robobt.live import Live, Server

SECONDS = 60.0
SPEED = 1.0

match = robobt.Match(robobt.load_scenario("three_v_three").lasting(SECONDS), seed=1)
with Server() as server, match:
    print(f"Live: {server.url}")
    Live(server, SPEED).play(match)

# %%
result = match.result()
print(f"{result.blue_score}:{result.yellow_score} after {result.time:.0f} s")

# %% [markdown]
# ![The live page](../images/live.png)
#
# Driving by game controller or keyboard, layers, charts: [the live page](../live.md).
