"""Plays named by their Python file: two files of one name, with the same names inside, never mix."""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Callable
from pathlib import Path

import pytest

from robobt.plays import PLAYS
from robobt.plays.files import contents_of, find_play, problem_with_play, rename_play
from robobt.plays.private_files import join_play, private_files, split_play
from robobt.plays.sources import PythonFileError
from robobt.skills import SKILLS
from robobt.skills.aim.raters import RATERS, make_rater
from robobt.tree import Behaviour
from robobt.tree.namespace import within

Write = Callable[..., str]

TEAM = """
    from robobt.plays import PLAYS
    from shape import Advance, tempo

    @PLAYS.register("striker")
    def striker(*, speed: float = 1.0):
        return Advance(speed=speed * tempo())
"""

SHAPE = """
    from robobt.skills.base import Skill, skill
    from robobt.tree import Status

    @skill
    class Advance(Skill):
        made = 0

        def __init__(self, *, speed: float = 1.0, name: str = "") -> None:
            super().__init__(name)
            self.speed = speed
            Advance.made += 1

        def on_running(self) -> Status:
            return self.run()

    def tempo() -> float:
        import settings
        return settings.TEMPO
"""

SETTINGS = """
    import my_team  # modules of a team may import each other
    TEMPO = {tempo}
"""


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Writes a file and returns its path."""

    def make(name: str, source: str) -> str:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(textwrap.dedent(source), encoding="utf-8")
        return str(path)

    return make


def state(write: Write, folder: str, tempo: float) -> str:
    """Write one state of a team and return its play's name."""
    write(f"{folder}/shape.py", SHAPE)
    write(f"{folder}/settings.py", SETTINGS.format(tempo=tempo))
    return f"{write(f'{folder}/my_team.py', TEAM)}:striker"


def build(play: str, **params: object) -> Behaviour:
    with within(private_files(play)):
        return find_play(play)(**params)


def test_two_states_of_a_team_have_their_own_plays_skills_and_modules(write: Write) -> None:
    old, new = state(write, "old", 0.5), state(write, "new", 2.0)
    assert (build(old, speed=3.0).speed, build(new, speed=3.0).speed) == (1.5, 6.0)  # type: ignore[attr-defined]
    build(new)
    one, other = type(build(old)), type(build(new))
    assert one is not other
    assert (one.made, other.made) == (2, 3)  # type: ignore[attr-defined]


def test_what_is_a_teams_is_nobody_elses(write: Write) -> None:
    before, path = set(sys.modules), list(sys.path)
    build(state(write, "old", 0.5))
    assert "striker" not in PLAYS
    assert "Advance" not in SKILLS
    assert sys.path == path
    assert not {"my_team", "shape", "settings"} & (set(sys.modules) - before)


def test_a_team_may_call_its_own_things_as_robobts_are_called(write: Write) -> None:
    file = write(
        "team.py",
        """
        from robobt.plays import PLAYS
        from robobt.skills import Stop
        from robobt.skills.aim.raters import RATERS, make_rater
        from robobt.skills.aim.raters.open_angle import OpenAngle

        @RATERS.register("gaussian")
        class Mine(OpenAngle):
            pass

        @PLAYS.register("take_shot")
        def take_shot():
            return Stop(name=type(make_rater("gaussian")).__name__)
        """,
    )
    assert build(f"{file}:take_shot").name == "Mine"
    assert build(f"{file}:stand_still").name == PLAYS["stand_still"]().name
    assert type(make_rater("gaussian")) is RATERS["gaussian"]
    assert type(make_rater("gaussian")).__name__ != "Mine"


def test_a_tree_file_names_the_skills_of_the_python_file_before_it(write: Write) -> None:
    tree = write("tree.yaml", "play: mine\ntree: {Advance: {speed: 2.0}}\n")
    old, new = [write(f"{folder}/shape.py", SHAPE) for folder in ("old", "new")]
    one, other = build(join_play([old], tree)), build(join_play([new], tree))
    assert type(one) is not type(other)
    assert type(one).__module__.endswith(".shape")


def test_packages_relative_imports_and_modules_found_by_their_folder_are_the_teams_own(write: Write) -> None:
    plays = []
    for number, folder in enumerate(("old", "new")):
        write(f"{folder}/lib/__init__.py", "")
        write(
            f"{folder}/lib/parts/__init__.py",
            """
            from pkgutil import iter_modules
            from importlib import import_module
            ALL = [import_module(f"{__name__}.{one.name}").VALUE for one in iter_modules(__path__)]
            """,
        )
        write(f"{folder}/lib/parts/first.py", f"VALUE = {number}")
        plays.append(
            write(
                f"{folder}/lib/plays.py",
                """
                import lib.parts.first as first
                from robobt.plays import PLAYS
                from robobt.skills import Stop
                from . import parts
                from .parts.first import VALUE

                @PLAYS.register("own")
                def own():
                    return Stop(name=f"{parts.ALL} {VALUE} {first.VALUE}")
                """,
            )
        )
    assert [build(f"{play}:own").name for play in plays] == ["[0] 0 0", "[1] 1 1"]


@pytest.mark.parametrize("changed", ["my_team.py", "shape.py", "settings.py"])
def test_states_differ_by_what_any_of_their_modules_says(write: Write, changed: str, tmp_path: Path) -> None:
    old, new = state(write, "old", 1.0), state(write, "new", 1.0)
    assert contents_of(old) == contents_of(new)
    third = state(write, "third", 1.0)
    with (tmp_path / "third" / changed).open("a") as file:
        file.write("# another state\n")
    assert contents_of(third) != contents_of(old)


def test_a_file_called_like_a_module_of_python_takes_nobodys_place(write: Write) -> None:
    file = write("json.py", "import json\nfrom robobt.plays import PLAYS\nASKED = json.dumps([1])\n")
    owner = private_files(f"{file}:anything")
    assert owner is not None
    assert sys.modules[f"{owner.package}.json"].ASKED == "[1]"


def test_a_name_is_split_into_files_and_play() -> None:
    assert split_play("striker") == ((), "striker")
    assert split_play("six_v_six:blue") == ((), "six_v_six:blue")
    assert split_play("a/b.py,c.py:striker") == (("a/b.py", "c.py"), "striker")
    assert rename_play("a.py,b.py:striker", "x/{}".format) == "x/a.py,x/b.py:striker"
    assert rename_play("a.py:tree.yaml", "x/{}".format) == "x/a.py:x/tree.yaml"
    assert rename_play("striker", "x/{}".format) == "striker"


@pytest.mark.parametrize(
    ("source", "name", "problem"),
    [
        ("x = = 1\n", "striker", ":1: invalid syntax"),
        ("import nothing_of_that_name\n", "striker", ":1: ModuleNotFoundError"),
        ("from robobt.plays import PLAYS\n", "striker", "no play is called 'striker' in "),
    ],
)
def test_what_is_wrong_with_a_file_is_one_line(write: Write, source: str, name: str, problem: str) -> None:
    said = problem_with_play(f"{write('bad.py', source)}:{name}")
    assert said is not None
    assert problem in said
    assert "bad.py" in said


@pytest.mark.parametrize("model", ["duel_ppo", "models/duel_ppo.pt"])
def test_a_model_is_no_play(model: str) -> None:
    assert f"'{model}' is a model, not a play" in str(problem_with_play(model))


def test_a_file_alone_is_told_its_plays(write: Write) -> None:
    play = state(write, "old", 1.0)
    file = play.rpartition(":")[0]
    assert problem_with_play(file) == f"{file} is a Python file; name a play of it: {play}"


def test_a_file_that_is_not_there_is_told() -> None:
    with pytest.raises(PythonFileError, match=r"gone.py: cannot be read"):
        private_files("gone.py:striker")
