"""Build hook: compiles the league's messages (``robobt/league/wire/proto/*.proto``), notes the commit.

What is made is a set of descriptors, which the package loads into a pool of its
own (``robobt/league/wire/messages.py``): it fits any version of the protobuf runtime,
and other packages that define messages of the same names do not get in its way.
Beside it lie type stubs for editors and type checkers. Run as a script it does
the same in place.

A wheel and an sdist say from which commit they were made (``robobt/commit.txt``), for the cards of
models that are trained with them. A wheel carries the models that a play, a scenario or the README names. It
leaves out the others, and the shots that some models learned from; a clone has all.
"""

from __future__ import annotations

import runpy
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

LEFT_OUT = {
    "go_to_ball_among_robots_ppo.pt",
    "save_ppo.pt",
    "score_on_goalkeeper_robust.pt",
    "shoot_robust.pt",
    "paper_shots.parquet",
}
"""Files of ``models`` that are not in a wheel; the manifest there still lists the models among them."""

_FOLDER = Path("robobt/league/wire/proto")
_DESCRIPTORS = _FOLDER / "messages.desc"


def compile_messages(root: Path) -> list[str]:
    """Compile all messages below ``root``; returns what was written, relative to it.

    Raises:
        RuntimeError: the compiler refused a file; it has said why on stderr.
    """
    import grpc_tools
    from grpc_tools import protoc

    sources = sorted(path.relative_to(root).as_posix() for path in (root / _FOLDER).glob("*.proto"))
    status = protoc.main(
        [
            "protoc",
            f"--proto_path={root}",
            f"--proto_path={Path(grpc_tools.__file__).parent / '_proto'}",
            "--include_imports",
            f"--descriptor_set_out={root / _DESCRIPTORS}",
            f"--pyi_out={root}",
            *sources,
        ]
    )
    if status != 0:
        raise RuntimeError(f"protoc ended with {status}")
    stubs = [f"{source.removesuffix('.proto')}_pb2.pyi" for source in sources]
    return [_DESCRIPTORS.as_posix(), *stubs]


class MessagesHook(BuildHookInterface):  # type: ignore[type-arg]
    """Compiles the messages and notes the commit before anything is built."""

    _written: TemporaryDirectory[str] | None = None

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """See hatchling."""
        build_data["artifacts"] += [f"/{path}" for path in compile_messages(Path(self.root))]
        if self.target_name == "wheel" and version != "editable":
            for path in sorted((Path(self.root) / "models").iterdir()):
                if path.name not in LEFT_OUT:
                    build_data["force_include"][str(path)] = f"robobt/_data/models/{path.name}"
        package = Path(self.root) / "robobt"
        commit = runpy.run_path(str(package / "config" / "commit.py"))["commit_of"](package)
        # An editable installation asks git itself, an sdist has the file already.
        if commit and version != "editable":
            self._written = TemporaryDirectory()
            file = Path(self._written.name) / "commit.txt"
            file.write_text(f"{commit}\n", "ascii")
            build_data["force_include"][str(file)] = "robobt/commit.txt"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:  # noqa: ARG002
        """See hatchling."""
        if self._written is not None:
            self._written.cleanup()


if __name__ == "__main__":
    compile_messages(Path(__file__).parent)
