"""Names the twenty tests that take most processor time, whatever else the machine does: `make durations`.

A plugin of pytest (`-p tests.dearest`). All parameters of a test count together, and so do the processes that
it starts and waits for.
"""

from __future__ import annotations

import resource
from collections import Counter
from collections.abc import Iterator

import pytest

from tests import workers

_SHOWN = 20
_BEGAN = pytest.StashKey[float]()
_SPENT: Counter[str] = Counter()


def _processor_time() -> float:
    times = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(time.ru_utime + time.ru_stime for time in times) + workers.processor_time()


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    item.stash[_BEGAN] = _processor_time()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[None]) -> Iterator[None]:
    report = yield
    if call.when == "teardown":
        # Reports, unlike items, reach the process that started the workers.
        report.user_properties.append(("processor time", _processor_time() - item.stash[_BEGAN]))
    return report


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    _SPENT[report.nodeid.partition("[")[0]] += dict(report.user_properties).get("processor time", 0.0)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    terminalreporter.section(f"the {_SHOWN} dearest of {_SPENT.total():.0f} s of processor time")
    for name, spent in _SPENT.most_common(_SHOWN):
        terminalreporter.write_line(f"{spent:6.1f} s  {name}")
