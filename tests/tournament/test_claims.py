"""Claims: no match is played by two programs at once, and none stays claimed by a dead one."""

from __future__ import annotations

import errno
import subprocess
import sys
from pathlib import Path

import pytest

from robobt.tournament.claims import Claims

CLAIM = """
import sys
from pathlib import Path
from robobt.tournament.claims import Claims
with Claims(Path(sys.argv[1])) as claims:
    print(claims.take("x"), claims.take("y"), flush=True)
    sys.stdin.read()
"""


@pytest.mark.integration
@pytest.mark.skipif(sys.platform == "win32", reason="there are no such locks here")
def test_a_claim_keeps_others_out_until_its_program_is_gone(
    tmp_path: Path,
) -> None:
    path = tmp_path / "night.sqlite"
    other = subprocess.Popen(
        [sys.executable, "-c", CLAIM, str(path)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    with other, Claims(path) as claims:
        try:
            assert other.stdout is not None
            assert other.stdout.readline() == "True True\n"
            assert not claims.take("x")
            assert claims.take("z")
        finally:
            other.kill()
        other.wait()
        assert claims.take("x")


def test_what_is_released_can_be_claimed_again(tmp_path: Path) -> None:
    with Claims(tmp_path / "night.sqlite") as claims:
        assert claims.take("x")
        claims.release("x")
        assert claims.take("x")


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such locks here")
def test_a_folder_without_locks_is_an_error_and_no_claim(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def without_locks(*_: object) -> None:
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr("fcntl.lockf", without_locks)
    told = pytest.raises(OSError, match="cannot be locked")
    with Claims(tmp_path / "night.sqlite") as claims, told as raised:
        claims.take("x")
    assert raised.value.filename == str(tmp_path / ".night.sqlite.claims")
