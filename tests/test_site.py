"""The site is built without a warning, asks nothing outside, and its search answers, opened from the disk."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.live.chromium import Page, chromium

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parent.parent

TASKS = [
    (["add a skill", "own skill"], "tutorials/03_write_your_own_skill.html"),
    (["where is a goal decided"], "architecture.html"),
    (["from tree to network", "how a command gets to the network"], "architecture.html"),
    (["reward term"], "environments.html"),
    (["train with own reward"], "environments.html"),
    (["own predictor"], "shots.html"),
    (["two against two"], "scenarios.html"),
    (["run a league world", "play in grSim"], "league.html"),
    (["run a tournament"], "tournament.html"),
    (["gamepad"], "live.html"),
]
"""What newcomers look for, in at most two queries each, and the page that answers."""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("mkdocs", reason='the site needs pip install "robobt[docs]"')
    folder = tmp_path_factory.mktemp("site")
    build = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(folder)]
    done = subprocess.run(build, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture(scope="module")
def page(site: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    with chromium(tmp_path_factory.mktemp("chromium")) as page:
        yield page
        assert page.complaints() == []


def test_no_page_names_an_outside_address_to_load(site: Path) -> None:
    for page in site.rglob("*.html"):
        loaded = re.findall(
            r"<(?:script|img|link|iframe)\b[^>]*\b(?:src|href)=\"?(https?://[^\" >]+)", page.read_text()
        )
        assert not [address for address in loaded if "rel=canonical" not in address], page


@pytest.mark.parametrize(("queries", "answer"), TASKS)
def test_the_search_answers_a_newcomer(page: Page, site: Path, queries: list[str], answer: str) -> None:
    assert len(queries) <= 2
    for query in queries:
        page.open("about:blank")
        page.open((site / "index.html").as_uri())
        field = page.find("input[data-md-component=search-query]")
        page.js("arguments[0].focus(); arguments[0].value = arguments[1]", field, query)
        page.js("arguments[0].dispatchEvent(new Event('keyup'))", field)
        page.wait("return document.querySelector('.md-search-result__link')")
        links = page.js(
            "return [...document.querySelectorAll('.md-search-result__link')].map(link => link.href)"
        )
        pages = list(dict.fromkeys(link.partition("?")[0].partition("#")[0] for link in links))
        if any(link.endswith(f"/{answer}") for link in pages[:3]):
            break
    else:
        pytest.fail(f"the first pages of {queries} are {pages[:3]}")
    asked = page.js("return performance.getEntriesByType('resource').map(entry => entry.name)")
    assert [address for address in asked if not address.startswith("file:")] == []
