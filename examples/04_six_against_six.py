"""4. Six against six: two teams, a referee, twelve trees, and who is doing what.

Plays the bundled scenario tick by tick, tells every restart and goal as it
happens, and records the match.

    python examples/04_six_against_six.py [seconds]
"""

import sys

import robobt


def main(seconds: float = 60.0) -> None:
    scenario = robobt.load_scenario("six_v_six").lasting(seconds)
    match = robobt.Match(scenario, 1, record="out/six_v_six.robobt.arrows")
    command = None
    with match:  # closes the recording
        while match.tick():
            game = match.game
            if game.command is not command:
                command = game.command
                time = match.world.truth().time
                print(f"{time:6.2f} s  {game.blue_score}:{game.yellow_score}  {command.name}")
    result = match.result()
    played = f"ball in play {result.in_play:.0%} of {result.time:.0f} s"
    print(f"\n{result.blue_score}:{result.yellow_score}, {played}")
    for player in match.players:
        tip = player.runner.root.tip()
        doing = "nothing" if tip is None else f"{tip.name}: {tip.feedback_message}"
        print(f"  {player.robot!s:9} {doing}")
    print("robobt replay out/six_v_six.robobt.arrows   makes a page of it")


if __name__ == "__main__":
    main(*map(float, sys.argv[1:]))
