from collections.abc import Iterator

import pytest

from tests.live.chromium import Page, chromium


@pytest.fixture(scope="session")
def chromium_page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    with chromium(tmp_path_factory.mktemp("chromium")) as page:
        yield page


@pytest.fixture
def page(chromium_page: Page) -> Iterator[Page]:
    """A page of usual size, in which nothing may have gone wrong at the end."""
    chromium_page.size(1400, 900)
    chromium_page.dark(False)
    chromium_page.open("about:blank")
    chromium_page.complaints()
    yield chromium_page
    assert chromium_page.complaints() == []
