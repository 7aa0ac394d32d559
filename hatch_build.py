"""Build hook: compiles the league's messages (``robobt/league/wire/proto/*.proto``).

What is made is a set of descriptors, which the package loads into a pool of its
own (``robobt/league/wire/messages.py``): it fits any version of the protobuf runtime,
and other packages that define messages of the same names do not get in its way.
Beside it lie type stubs for editors and type checkers. Run as a script it does
the same in place.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

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
    """Compiles the messages before a wheel, an editable installation or an sdist is built."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:  # noqa: ARG002
        """See hatchling."""
        build_data["artifacts"] += [f"/{path}" for path in compile_messages(Path(self.root))]


if __name__ == "__main__":
    compile_messages(Path(__file__).parent)
