"""Make the pictures of the live page in the documents: `python -m tests.live.pictures`, with Chromium."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from tests.live.chromium import Page, chromium
from tests.live.playing import playing
from tests.waiting import soon

FOLDER = Path(__file__).parents[2] / "docs" / "images"
SHOWN = 8.0
"""How far into the match the pictures are [s]."""


def save(page: Page, name: str) -> None:
    page.driver.save_screenshot(str(FOLDER / f"{name}.png"))


def main() -> None:
    with TemporaryDirectory() as profile, playing("six_v_six") as session, chromium(Path(profile)) as page:
        page.size(1400, 900)
        page.dark(False)
        page.open(f"{session.server.url}#robot=blue 4")
        page.wait("return document.querySelector('.live button[aria-pressed=true]') !== null")
        for layer in ("paths", "targets"):
            page.wait(f"return document.querySelector('.choices input[name={layer}]') !== null")
            page.js(f"document.querySelector('.choices input[name={layer}]').click()")
        soon(lambda: session.match.measures.ticks * session.match.scenario.period > SHOWN)
        page.find("#play").click()
        page.wait("return document.querySelector('#head').textContent.includes('paused')")
        save(page, "live")
        page.size(1400, 960)
        page.dark(True)
        page.button("Chart").click()
        save(page, "live_dark")
        page.button("Chart").click()
        page.dark(False)
        page.size(390, 844, phone=True)
        save(page, "live_phone")


if __name__ == "__main__":
    main()
