"""Wheel and sdist are complete: outside the checkout they play the bundled scenarios and load the models."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

from hatch_build import LEFT_OUT
from robobt.config.commit import commit_of

ROOT = Path(__file__).parent.parent


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("dist")
    build = [sys.executable, "-m", "hatchling", "build", "-d", str(folder)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    (wheel,), (sdist,) = folder.glob("robobt-*.whl"), folder.glob("robobt-*.tar.gz")
    return {"wheel": wheel, "sdist": sdist}


@pytest.fixture(scope="module")
def unpacked(built: dict[str, Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    target = tmp_path_factory.mktemp("site")
    with zipfile.ZipFile(built["wheel"]) as archive:
        archive.extractall(target)
    return target


def interpreter(version: str) -> str:
    python = shutil.which(f"python{version}")
    if python is None or subprocess.run([python, "-c", ""], check=False, capture_output=True).returncode:
        pytest.skip(f"there is no Python {version} here")
    return python


class Clean:
    """An environment with the package, in the versions of constraints.txt, and nothing of the checkout."""

    def __init__(self, python: str, folder: Path) -> None:
        self.folder = folder
        subprocess.run([python, "-m", "venv", str(folder / "clean")], check=True)
        self.programs = folder / "clean" / "bin"

    def install(self, *packages: str) -> None:
        pip = [str(self.programs / "python"), "-m", "pip", "install", "--quiet"]
        subprocess.run([*pip, "-c", str(ROOT / "constraints.txt"), *packages], check=True)

    def run(self, program: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        outside = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        called = [str(self.programs / program), *arguments]
        return subprocess.run(
            called, cwd=self.folder, env=outside, capture_output=True, text=True, check=False
        )

    def size(self) -> int:
        """Return the size of what was installed [bytes]."""
        (site,) = (self.folder / "clean" / "lib").glob("python*/site-packages")
        files = [file for file in site.rglob("*") if file.is_file()]
        tools = ("pip", "setuptools")
        return sum(file.stat().st_size for file in files if file.relative_to(site).parts[0] not in tools)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("version", "kind"), [("3.11", "wheel"), ("3.12", "wheel"), ("3.13", "wheel"), ("3.11", "sdist")]
)
def test_it_plays_and_loads_its_models_where_nothing_else_is_installed(
    version: str, kind: str, built: dict[str, Path], tmp_path: Path
) -> None:
    clean = Clean(interpreter(version), tmp_path)
    needed = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    clean.install(*[one for one in needed if not one.startswith("torch")])
    clean.install("--no-deps", str(built[kind]))

    # Without PyTorch, which a match of hand-written skills does not import.
    played = clean.run("robobt", "match", "striker_vs_goalkeeper", "--trials", "2", "--json")
    assert played.returncode == 0, played.stderr
    assert json.loads(played.stdout)["trials"] == 2
    refused = clean.run("robobt", "match", "striker_vs_goalkeeper", "--trials", "1", "--record", "x.html")
    assert 'pip install "robobt[record]"' in refused.stderr
    assert clean.size() < 350e6

    said = json.loads(clean.run("robobt", "list", "models", "--json").stdout)
    listed = said["models"]
    assert said["problems"] == []
    shipped = {path.stem for path in ROOT.glob("models/*.pt") if kind == "sdist" or path.name not in LEFT_OUT}
    assert {model["card"]["name"] for model in listed} == shipped
    if sys.version_info[:2] != tuple(map(int, version.split("."))):
        return  # of the PyTorch of other versions several gigabytes may be fetched
    clean.install("torch")
    models = [model["card"]["name"] for model in listed]
    scenarios = [path.stem for path in ROOT.glob("examples/scenarios/*.yaml")]
    for load, names in (("load_policy", models), ("load_scenario", scenarios)):
        loaded = clean.run("python", "-c", f"import robobt\nfor name in {names}: robobt.{load}(name)")
        assert loaded.returncode == 0, loaded.stderr
    played = clean.run("robobt", "match", "table4_trial1_ddpg", "--trials", "1", "--json")
    assert played.returncode == 0, played.stderr


def run(unpacked: Path, where: Path, code: str) -> str:
    environment = dict(os.environ, PYTHONPATH=str(unpacked))
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=where, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


ASKED = {
    "place": "import robobt; print(robobt.__file__)",
    "commit": "from robobt.config.commit import source_commit; print(source_commit())",
    "load": "from robobt import RobobtError, load_policy\n"
    "try: load_policy('save_ppo')\n"
    "except RobobtError as error: print(error)",
    "models": "app(['list', 'models', '--json'])",
    "left out": "app(['show', 'save_ppo'], standalone_mode=False)",
    "scenarios": "app(['list', 'scenarios', '--json'])",
    "model": "app(['show', 'duel_ppo', '--json'])",
}
"""What is asked outside the checkout, in one process, which starts sooner than seven."""


@pytest.fixture(scope="module")
def said(unpacked: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """What is answered."""
    code = (
        "import sys\nsys.stderr = sys.stdout\nfrom robobt.cli import app\n"
        f"for code in {[*ASKED.values()]!r}:\n"
        "    try: exec(code)\n"
        "    except SystemExit as end: assert not end.code, (code, end.code)\n"
        "    print('\\0', end='')"
    )
    *answers, rest = run(unpacked, tmp_path_factory.mktemp("outside"), code).split("\0")
    assert rest == ""
    return dict(zip(ASKED, answers, strict=True))


@pytest.mark.integration
def test_it_carries_types_scenarios_and_models(unpacked: Path) -> None:
    assert (unpacked / "robobt" / "py.typed").exists()
    assert list((unpacked / "robobt" / "_data" / "scenarios").glob("*.yaml"))
    assert (unpacked / "robobt" / "_data" / "models" / "README.md").exists()
    assert not (unpacked / "tests").exists()
    for needless in ("*.parquet", "*.proto"):
        assert not list(unpacked.rglob(needless))


def test_it_leaves_out_no_model_that_the_package_or_the_readme_names() -> None:
    files = [ROOT / "README.md", *ROOT.rglob("robobt/**/*.py"), *ROOT.rglob("examples/**/*.*")]
    texts = "".join([path.read_text("utf-8") for path in files if path.suffix in (".md", ".py", ".yaml")])
    assert [name for name in LEFT_OUT if Path(name).stem in texts and name.endswith(".pt")] == []
    assert all((ROOT / "models" / name).is_file() for name in LEFT_OUT)


@pytest.mark.integration
def test_it_says_where_a_model_is_that_it_leaves_out(unpacked: Path, said: dict[str, str]) -> None:
    models = {path.name for path in (unpacked / "robobt" / "_data" / "models").glob("*.pt")}
    assert models == {path.name for path in ROOT.glob("models/*.pt")} - LEFT_OUT
    assert "'save_ppo' is not installed: it is in the folder models of robobt's repository" in said["load"]
    assert json.loads(said["models"])["problems"] == []
    assert said["left out"] == f"robobt: {said['load']}"


@pytest.mark.integration
def test_it_knows_its_commit(said: dict[str, str]) -> None:
    assert said["commit"].strip() == commit_of(ROOT / "robobt")


OWN_TEST = """
from robobt import Status
from robobt.skills import HasBall
from robobt.testing import frame, held, robot


def test_it_has_the_ball(tick_on, make_store):
    me = robot(number=3)
    seen = frame(me, held(me))
    assert tick_on(HasBall(), [seen, frame(me, (2.0, 0.0))], make_store(seen, 3)) == [
        Status.SUCCESS,
        Status.FAILURE,
    ]
"""


@pytest.mark.integration
def test_pytest_finds_its_fixtures_without_being_told(unpacked: Path, tmp_path: Path) -> None:
    (tmp_path / "test_own.py").write_text(OWN_TEST)
    code = "import pytest, sys; sys.exit(pytest.main(['-q', '-W', 'error']))"
    assert "1 passed" in run(unpacked, tmp_path, code)


@pytest.mark.integration
def test_it_finds_its_scenarios_and_models_outside_the_checkout(unpacked: Path, said: dict[str, str]) -> None:
    # It plays there in the slow test above: what is installed anew is compiled anew.
    assert said["place"].startswith(str(unpacked))
    assert "striker_vs_goalkeeper" in said["scenarios"]
    assert json.loads(said["model"])["models"][0]["file"].startswith(str(unpacked))
