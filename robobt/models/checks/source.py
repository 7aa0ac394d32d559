"""The code in a TorchScript archive, read by Python's parser and written again for torch's.

Torch's dialect of Python can do more than a network needs. What is not named here is refused, and torch
is given what was understood here rather than the file's own text, so that the two parsers
cannot take it for different things.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping

from robobt.models.checks.dialect import ArchiveCode, Class, check_type, is_literal, is_text, plain, refusal
from robobt.models.checks.functions import check_functions
from robobt.models.checks.limits import DEEPEST_NESTING
from robobt.models.checks.pickles import check_pickles
from robobt.models.file import ModelError

_LONGEST_SOURCE = 2**20
_LONGEST_LINE = 20_000
_TEXT = re.compile(r"[ -~\n]*")


def checked_members(members: Mapping[str, bytes]) -> dict[str, bytes]:
    """Check that an archive holds a network, and return what torch may read of it.

    Loading it then runs nothing: its code has functions and modules of plain operations, and
    its pickles make modules, tensors and plain values, as its code describes them.
    """
    sources = _read_sources({name: content for name, content in members.items() if name.startswith("code/")})
    check_pickles(members, sources)
    if members.get("byteorder", b"little") != b"little":
        raise ModelError("was written by a machine with another order of bytes")
    return {**members, **sources.texts}


def _read_sources(members: Mapping[str, bytes]) -> ArchiveCode:
    """Read an archive's code (its members ``code/….py``) and check that it is a network's."""
    sources = ArchiveCode()
    for name, content in members.items():
        tree = _parsed(name, content)
        prefix = name.removeprefix("code/").removesuffix(".py").replace("/", ".")
        for statement in tree.body:
            _declare(sources, prefix, statement)
        sources.texts[name] = f"{ast.unparse(tree)}\n".encode()
    for one in sources.classes.values():
        for kind in one.attributes.values():
            check_type(kind, sources)
    check_functions(sources)
    return sources


def _parsed(name: str, content: bytes) -> ast.Module:
    if len(content) > _LONGEST_SOURCE:
        raise ModelError(f"{name} in it is longer than {_LONGEST_SOURCE} bytes")
    try:
        text = content.decode("ascii")
        if not _TEXT.fullmatch(text) or max([len(line) for line in text.split("\n")]) > _LONGEST_LINE:
            raise ModelError(f"{name} in it is no code as torch writes it")
        tree = ast.parse(text)
    except ModelError:
        raise
    except (ValueError, SyntaxError, RecursionError, MemoryError) as error:
        raise ModelError(f"{name} in it is damaged ({type(error).__name__})") from error
    level: list[ast.AST] = [tree]
    for _ in range(DEEPEST_NESTING):
        level = [child for node in level for child in ast.iter_child_nodes(node)]
    if level:
        raise ModelError(f"{name} in it is nested more than {DEEPEST_NESTING} deep")
    return tree


def _declare(sources: ArchiveCode, prefix: str, statement: ast.stmt) -> None:
    if not isinstance(statement, ast.ClassDef | ast.FunctionDef):
        raise refusal(statement)
    qualified = f"{prefix}.{plain(statement.name)}"
    if qualified in sources.classes or qualified in sources.functions:
        raise ModelError(f"defines {qualified} twice")
    match statement:
        case ast.FunctionDef():
            sources.functions[qualified] = statement
        case ast.ClassDef(
            bases=[ast.Name(id="Module" | "NamedTuple" as base)], keywords=[], decorator_list=[]
        ):
            one = sources.classes[qualified] = Class(base == "Module")
            for line in statement.body:
                _declare_in_class(one, line)
        case _:
            raise refusal(statement)


def _declare_in_class(one: Class, line: ast.stmt) -> None:
    name = ""
    match line:
        case ast.Assign(targets=[ast.Name(id="__parameters__" | "__buffers__")], value=ast.List(elts=names)):
            if not all(is_text(each) for each in names):
                raise refusal(line)
            return
        case ast.AnnAssign(ast.Name(), ast.Subscript(ast.Name(id="Final")), ast.expr() as value):
            if not is_literal(value):
                raise refusal(line)
            return
        case ast.FunctionDef(name="__len__", body=[ast.Return(ast.Constant(int()))]) if one.module:
            return
        case ast.Assign([ast.Subscript(ast.Name(id="__annotations__"), ast.Constant(str(name)))], kind):
            known: bool = name in one.attributes
            one.attributes[name] = kind
        case ast.AnnAssign(ast.Name(id=name), kind, None):
            known = name in one.attributes
            one.attributes[plain(name)] = kind
        case ast.FunctionDef(name) if one.module:
            known = name in one.methods
            one.methods[plain(name)] = line
        case _:
            raise refusal(line)
    if known:
        raise ModelError(f"defines {name} twice")
