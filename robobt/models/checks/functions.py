"""What the functions of a TorchScript archive do, statement by statement, and what they come to."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable

from robobt.models.checks.dialect import (
    TAKEN,
    ArchiveCode,
    Class,
    check_type,
    check_variable,
    dotted,
    is_literal,
    is_text,
    refusal,
)
from robobt.models.checks.divisions import FOLDED, Divisions
from robobt.models.checks.operations import TORCH
from robobt.models.file import ModelError

_LONGEST_LIST = 1000
_LARGEST_COST = 3_000
"""Of operations that a method comes to when the methods it calls are written out."""
_LOOP = 32
"""As often torch writes out the body of a loop while it freezes a module; it runs none."""
_PRIM = frozenset({"NumToTensor", "device", "dtype"})
_SCALARS = frozenset({"int", "float", "bool"})
_WITH_TEXTS = frozenset({"torch.div", "torch.gelu"})
"""Operations with an option that is a text."""


def check_functions(sources: ArchiveCode) -> None:
    """Check all methods and functions of an archive, and count its entries in the table of constants."""
    checker = _Checker(sources)
    for qualified, one in sources.classes.items():
        for method in one.methods.values():
            checker.cost(f"{qualified}.{method.name}", method, qualified)
    for qualified, function in sources.functions.items():
        checker.cost(qualified, function, None)


class _Checker:
    """Goes through functions, and counts what they come to."""

    def __init__(self, sources: ArchiveCode) -> None:
        self._sources = sources
        self._costs: dict[str, int | None] = {}

    def cost(self, qualified: str, function: ast.FunctionDef, owner: str | None) -> int:
        """Check a function and return the number of its operations, those of its callees included."""
        if qualified not in self._costs:
            self._costs[qualified] = None
            body = _Body(self, self._sources, function, owner)
            self._costs[qualified] = body.cost
        found = self._costs[qualified]
        if found is None:
            raise ModelError(f"has a function {function.name} in it that calls itself")
        if found > _LARGEST_COST:
            raise ModelError(f"takes more than {_LARGEST_COST} operations")
        return found


class _Body:
    """One function, checked from its first line to its last."""

    def __init__(
        self, checker: _Checker, sources: ArchiveCode, function: ast.FunctionDef, owner: str | None
    ) -> None:
        self._checker = checker
        self._sources = sources
        self._known: dict[str, str] = {}
        """Modules and functions by the local names that stand for them."""
        self._texts: set[str] = set()
        self._divisions = Divisions(self._attribute)
        self.cost = 1
        given = function.args
        if given.posonlyargs or given.kwonlyargs or given.vararg or given.kwarg or function.decorator_list:
            raise refusal(function)
        for place, one in enumerate(given.args):
            check_variable(one.arg)
            if one.annotation is None:
                raise refusal(function)
            check_type(one.annotation, sources)
            if dotted(one.annotation) == "str":
                self._texts.add(one.arg)
            self._divisions.bind_parameter(one.arg, one.annotation)
            if place == 0 and owner is not None:
                if dotted(one.annotation) != owner:
                    raise refusal(function)
                self._known[one.arg] = owner
        for default in given.defaults:
            if not is_literal(default):
                raise refusal(function)
        if (owner is not None and not given.args) or function.returns is None:
            raise refusal(function)
        check_type(function.returns, sources)
        self._block(function.body)

    def _block(self, lines: Iterable[ast.stmt]) -> None:
        for line in lines:
            self._line(line)

    def _line(self, line: ast.stmt) -> None:
        match line:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                self._assign(name, value)
            case ast.Assign(targets=[ast.Tuple(elts=names)], value=value):
                self._value(value)
                for one in names:
                    if not isinstance(one, ast.Name):
                        raise refusal(line)
                    self._bind(one.id, None, value)
            case ast.AnnAssign(target=ast.Name(id=name), annotation=kind, value=ast.expr() as value):
                check_type(kind, self._sources)
                self._assign(name, value)
            case ast.Return(value=ast.expr() as value):
                self._value(value)
            case ast.If(test=test, body=body, orelse=orelse):
                self._value(test)
                self._block(body)
                self._block(orelse)
            case ast.For(
                target=ast.Name(id=name), iter=ast.Call(ast.Name(id="range"), [count], []), orelse=[]
            ):
                self._loop(name, count, line.body)
            case ast.Expr(ast.Call(ast.Attribute(attr="RaiseException", value=owner), [message, *kind], [])):
                if dotted(owner) != "ops.prim" or not all(is_text(one) for one in kind):
                    raise refusal(line)
                if not self._is_text(message):
                    raise refusal(message)
            case ast.Expr(ast.Call() as call):
                self._value(call)
            case ast.Pass():
                pass
            case ast.While():
                raise ModelError("has a loop in it; a policy is a plain network")
            case _:
                raise refusal(line)

    def _loop(self, name: str, count: ast.expr, lines: list[ast.stmt]) -> None:
        # Torch's check of a batch counts over the axes of a shape; nothing else may go round.
        if isinstance(count, ast.Call) and dotted(count.func) == "torch.sub" and len(count.args) == 2:
            count = count.args[0]
        if not (isinstance(count, ast.Call) and dotted(count.func) == "torch.len"):
            raise ModelError("has a loop in it; a policy is a plain network")
        if not all(isinstance(line, ast.Assign) for line in lines):
            raise ModelError("has a loop in it; a policy is a plain network")
        self._value(count)
        self._bind(name, None)
        before = self.cost
        self._block(lines)
        self.cost = before + _LOOP * (self.cost - before)

    def _assign(self, name: str, value: ast.expr) -> None:
        stands_for = self._stands_for(value)
        text = self._is_text(value)
        if stands_for is None and not text:
            self._value(value)
        self._bind(name, stands_for, value)
        if text:
            self._texts.add(name)

    def _bind(self, name: str, stands_for: str | None, value: ast.expr | None = None) -> None:
        check_variable(name)
        self._divisions.bind(name, value)
        if name in self._texts or (name in self._known and self._known[name] != stands_for):
            raise ModelError(f"gives {name} a second meaning")
        if stands_for is not None:
            self._known[name] = stands_for

    def _is_text(self, value: ast.expr) -> bool:
        """Return whether a value is a text: what an exception says, or a piece of it.

        Torch puts texts together while it reads the code. They go nowhere but into exceptions, and
        into none of them twice.
        """
        match value:
            case ast.Name(id=name):
                return name in self._texts
            case ast.Call(func=func, args=[pattern, *args], keywords=[]) if dotted(func) == "torch.format":
                if not self._is_text(pattern):
                    raise refusal(value)
                for one in args:
                    self._value(one)
                return True
        return is_text(value)

    def _stands_for(self, value: ast.expr) -> str | None:
        """Return the qualified name of the module or function that an expression is, None for a value."""
        match value:
            case ast.Name(id=name):
                return self._known.get(name)
            case ast.Call(ast.Name(id="getattr"), [owner, ast.Constant(str(attribute))], []):
                return self._part(owner, attribute)
            case ast.Attribute(owner, attribute):
                qualified = dotted(value)
                if qualified is not None and (
                    qualified in self._sources.functions or qualified in self._sources.classes
                ):
                    return qualified
                return self._part(owner, attribute)
        return None

    def _part(self, owner: ast.expr, attribute: str) -> str | None:
        kind = self._attribute(owner, attribute)
        qualified = None if kind is None else dotted(kind)
        return qualified if qualified in self._sources.classes else None

    def _attribute(self, owner: ast.expr, attribute: str) -> ast.expr | None:
        held = self._sources.classes.get(self._stands_for(owner) or "")
        kind = held.attributes.get(attribute) if held is not None and held.module else None
        texts = kind is not None and any(
            isinstance(part, ast.Name) and part.id == "str" for part in ast.walk(kind)
        )
        return None if texts else kind

    def _value(self, value: ast.expr) -> None:
        match value:
            case ast.Name(id=name):
                if name in self._texts or name in self._known or name in TAKEN - {"inf", "nan"}:
                    raise refusal(value)
            case ast.UnaryOp(ast.USub(), ast.Constant(int() | float()) | ast.Name(id="inf" | "nan")):
                pass
            case ast.Constant():
                if not is_literal(value) or is_text(value):
                    raise refusal(value)
            case ast.List(elts=parts) | ast.Tuple(elts=parts):
                if len(parts) > _LONGEST_LIST:
                    raise refusal(value)
                for part in parts:
                    self._value(part)
            case ast.Subscript(ast.Name() | ast.Call() as whole, part):
                self._value(whole)
                self._value(part)
            case ast.Attribute(ast.Name(id="CONSTANTS"), entry) if re.fullmatch(r"c\d{1,4}", entry):
                self._sources.constants = max(self._sources.constants, int(entry[1:]) + 1)
            case ast.Attribute(owner, attribute) if self._attribute(owner, attribute) is not None:
                if self._stands_for(value) is not None:
                    raise refusal(value)
            case ast.Call():
                self._call(value)
            case _:
                raise refusal(value)

    def _call(self, call: ast.Call) -> None:
        self.cost += 1
        called = dotted(call.func)
        args = call.args
        with_texts = called in _WITH_TEXTS
        match call:
            case ast.Call(ast.Name(id="annotate" | "unchecked_cast"), [kind, value], []):
                check_type(kind, self._sources)
                args = [value]
            case ast.Call(ast.Name(id="uninitialized"), [kind], []):
                check_type(kind, self._sources)
                args = []
            case ast.Call(ast.Name(id="getattr"), [owner, ast.Constant(str(attribute))], []):
                if self._attribute(owner, attribute) is None or self._stands_for(call) is not None:
                    raise refusal(call)
                args = []
            case ast.Call(ast.Attribute(owner, method)) if self._module(owner) is not None:
                self.cost += self._method(owner, method)
                with_texts = True
            case _ if called is not None and called in _SCALARS:
                pass
            case _ if called is not None and called.startswith("ops.prim."):
                if called.removeprefix("ops.prim.") not in _PRIM:
                    raise refusal(call)
            case ast.Call(ast.Attribute(ast.Name(id="torch"), "device"), [ast.Constant("cpu")], []):
                args = []
            case ast.Call(ast.Attribute(ast.Name(id="torch"), operation)):
                if operation not in TORCH:
                    raise ModelError(f"does more than arithmetic: aten::{operation}")
                if operation in FOLDED:
                    self._divisions.check(call)
            case _:
                self.cost += self._function(call)
                with_texts = True
        for one in [*args, *[keyword.value for keyword in call.keywords]]:
            if not (with_texts and self._is_text(one)):
                self._value(one)

    def _module(self, owner: ast.expr) -> Class | None:
        held = self._sources.classes.get(self._stands_for(owner) or "")
        return held if held is not None and held.module else None

    def _method(self, owner: ast.expr, method: str) -> int:
        held, qualified = self._module(owner), self._stands_for(owner)
        if held is None or method not in held.methods:
            raise ModelError(f"calls a method {method} that is not in it")
        return self._checker.cost(f"{qualified}.{method}", held.methods[method], qualified)

    def _function(self, call: ast.Call) -> int:
        qualified = self._stands_for(call.func) or ""
        if qualified in self._sources.functions:
            return self._checker.cost(qualified, self._sources.functions[qualified], None)
        if qualified in self._sources.classes and not self._sources.classes[qualified].module:
            return 1
        raise refusal(call)
