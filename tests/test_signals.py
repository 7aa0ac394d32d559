"""Signals end what runs, wait for what has to be whole, and cannot be swallowed."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress

import pytest

from robobt import signals
from robobt.signals import TERMINATE, Terminated, check, ending, uninterrupted
from tests.conftest import StartPython
from tests.waiting import LIMIT


def send(number: int) -> None:
    os.kill(os.getpid(), number)


@pytest.fixture(autouse=True)
def _handlers_stay_as_they_were(signals_of_a_terminal: None) -> Iterator[None]:
    watched = (signal.SIGINT, *TERMINATE)
    before = [signal.getsignal(number) for number in watched]
    yield
    assert [signal.getsignal(number) for number in watched] == before


def raised_by(block: Callable[[], None]) -> BaseException:
    """What a block ends with."""
    with pytest.raises((SystemExit, KeyboardInterrupt)) as raised, ending():
        block()
    return raised.value


def sent(number: int) -> None:
    """A block that a signal interrupts."""
    send(number)
    time.sleep(60)


@pytest.mark.parametrize("number", TERMINATE)
def test_a_signal_to_terminate_ends_the_block_with_its_own_exit_status(number: int) -> None:
    ended = raised_by(lambda: sent(number))
    assert isinstance(ended, Terminated)
    assert ended.signal == number
    assert ended.code == 128 + number


def test_an_interrupt_is_a_keyboard_interrupt_even_where_the_shell_had_it_ignored() -> None:
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        assert isinstance(raised_by(lambda: sent(signal.SIGINT)), KeyboardInterrupt)
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)


def test_a_hang_up_that_nohup_ignores_stays_ignored() -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with ending():
            send(signal.SIGHUP)
            check()
    finally:
        signal.signal(signal.SIGHUP, before)


def test_a_signal_waits_for_the_end_of_what_must_be_whole() -> None:
    done = []

    def block() -> None:
        with uninterrupted:
            with uninterrupted:
                send(signal.SIGTERM)
            done.append("whole")
        done.append("more")

    assert isinstance(raised_by(block), Terminated)
    assert done == ["whole"]


def test_what_was_swallowed_is_raised_at_the_next_check() -> None:
    done = []

    def block() -> None:
        with suppress(SystemExit):
            sent(signal.SIGTERM)
        done.append("swallowed")
        check()
        done.append("more")

    assert isinstance(raised_by(block), Terminated)
    assert done == ["swallowed"]
    check()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_one_that_comes_while_something_is_deleted_prints_nothing_and_is_raised(
    number: int, capfd: pytest.CaptureFixture[str]
) -> None:
    class Deleted:
        def __del__(self) -> None:
            send(number)
            time.sleep(0.01)

    def block() -> None:
        for _ in range(2):
            Deleted()
            check()

    assert isinstance(raised_by(block), SystemExit | KeyboardInterrupt)
    assert capfd.readouterr().err == ""


def test_signals_that_come_together_are_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """As a service manager sends SIGTERM and SIGHUP: the second must not break the way out."""
    monkeypatch.setattr(signals, "_SAME_END_TIME", LIMIT)
    done = []

    def block() -> None:
        try:
            sent(signal.SIGTERM)
        finally:
            send(signal.SIGHUP)
            send(signal.SIGINT)
            done.append("cleaned up")

    assert isinstance(raised_by(block), Terminated)
    assert done == ["cleaned up"]


def test_a_later_signal_breaks_off_a_clean_up_that_takes_too_long(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(signals, "_SAME_END_TIME", 0.0)

    def block() -> None:
        try:
            sent(signal.SIGTERM)
        finally:
            sent(signal.SIGINT)

    assert isinstance(raised_by(block), KeyboardInterrupt)


def test_other_threads_are_left_alone() -> None:
    done = []

    def work() -> None:
        with ending(), uninterrupted:
            check()
            done.append("in a thread")

    def block() -> None:
        with uninterrupted:
            send(signal.SIGTERM)
            thread = threading.Thread(target=work)
            thread.start()
            thread.join()

    assert isinstance(raised_by(block), Terminated)
    assert done == ["in a thread"]


STUBBORN = """
import atexit, sys
from robobt.signals import at_the_latest_after, ending
atexit.register(print, "robots stopped", flush=True)
with ending(), at_the_latest_after(0.1):
    print("ready", flush=True)
    while True:
        try:
            while True:
                pass
        except:
            pass
"""


def test_who_swallows_every_exception_is_ended_by_force(start_python: StartPython) -> None:
    process = start_python("-c", STUBBORN)
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    process.send_signal(signal.SIGTERM)
    assert process.wait(LIMIT) == 128 + signal.SIGTERM
    assert process.stdout.readline() == "robots stopped\n"


LATE = """
import atexit, threading, time
from robobt.signals import at_the_latest_after, ending
forced, let_go = threading.Event(), threading.Event()
atexit.register(let_go.wait)
atexit.register(forced.set)
with ending():
    try:
        with at_the_latest_after(0.1):
            print("ready", flush=True)
            try:
                time.sleep(600)
            finally:
                forced.wait()
    finally:
        let_go.set()
        time.sleep(0.5)
        print("files finished", flush=True)
"""


def test_who_lets_go_while_its_end_is_being_forced_may_finish(start_python: StartPython) -> None:
    process = start_python("-c", LATE)
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    process.send_signal(signal.SIGTERM)
    assert process.wait(LIMIT) == 128 + signal.SIGTERM
    assert process.stdout.readline() == "files finished\n"
