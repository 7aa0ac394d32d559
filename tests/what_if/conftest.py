"""One recorded match for all tests of this room."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from robobt.what_if import Branches, LoggedMatch, load_logged
from tests.what_if.made import recorded


@pytest.fixture(scope="session")
def small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return recorded(tmp_path_factory.mktemp("what_if"))


@pytest.fixture(scope="session")
def logged(small: Path) -> LoggedMatch:
    return load_logged(small)


@pytest.fixture(scope="session")
def branches(logged: LoggedMatch) -> Iterator[Branches]:
    made = Branches(logged, seconds=1.0)
    yield made
    made.close()
