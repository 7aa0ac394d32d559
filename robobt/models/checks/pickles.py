"""The pickles in a TorchScript archive, read by a machine that knows what torch writes and no more.

Torch's own reader trusts what it reads: it makes room for any number of things, and follows tuples in
tuples until the stack is full.
"""

from __future__ import annotations

import pickletools
import re
from collections.abc import Callable, Mapping
from typing import Any

from robobt.models.checks.dialect import ArchiveCode
from robobt.models.checks.objects import (
    MOST_VALUES,
    Object,
    PickledName,
    Storage,
    Tensor,
    check_objects,
    check_plain,
)
from robobt.models.file import MAX_MODEL_SIZE, ModelError

_CLASS = re.compile(r"__torch__(\.\w+)* \w+")
_STORAGE = re.compile(r"torch (\w+)Storage")
_TAG = re.compile(r"[\w\[\], .]{1,200}")
_DEVICE = re.compile(r"cpu|cuda:\d")
_STORAGE_ITEM_SIZES = {"Bool": 1, "Byte": 1, "Char": 1, "Short": 2, "Half": 2, "BFloat16": 2}
_STORAGE_ITEM_SIZES |= {"Int": 4, "Float": 4, "Long": 8, "Double": 8}
_LIST_BUILDERS = {"build_intlist": int, "build_doublelist": float, "build_boollist": bool}
_STACK_MARK = object()


def check_pickles(members: Mapping[str, bytes], sources: ArchiveCode) -> None:
    """Check ``data.pkl`` and ``constants.pkl`` of an archive, and the weights that they name."""
    size = 0
    for name in ("constants.pkl", "data.pkl"):
        if name not in members:
            continue
        try:
            machine = _Machine(name.removesuffix(".pkl"), members)
            value = machine.run(members[name])
            size += machine.size
        except ModelError:
            raise
        except Exception as error:
            raise ModelError(f"{name} in it is damaged ({type(error).__name__})") from error
        if name == "data.pkl" and not isinstance(value, Object):
            raise ModelError("data.pkl in it is no module")
        if name == "constants.pkl" and (not isinstance(value, tuple) or len(value) < sources.constants):
            raise ModelError("constants.pkl in it lacks what the code names")
        if isinstance(value, tuple) and any(isinstance(one, int | float) for one in value):
            # Torch writes numbers into the code, where they are seen.
            raise ModelError("has numbers in constants.pkl")
        check_objects(value, sources)
    if sources.constants and "constants.pkl" not in members:
        raise ModelError("constants.pkl is missing in it")
    if size > MAX_MODEL_SIZE:
        raise ModelError("holds more than a model does")


class _Machine:
    """Runs a pickle's operations on values that do nothing."""

    def __init__(self, folder: str, members: Mapping[str, bytes]) -> None:
        self.size = 0
        self._folder = folder
        self._members = members
        self._stack: list[object] = []
        self._memo: list[object] = []

    def run(self, content: bytes) -> object:
        """Return what a pickle makes."""
        ended = -1
        for number, (operation, argument, at) in enumerate(pickletools.genops(content)):
            if number >= MOST_VALUES:
                raise ModelError("holds more than a model does")
            step = _OPCODE_STEPS.get(operation.name)
            if step is None:
                raise ModelError(f"holds a pickle with {operation.name}, which torch does not write")
            step(self, argument)
            ended = -1 if at is None else at
        (value,) = self._stack
        if ended != len(content) - 1 or value is _STACK_MARK:
            raise ModelError(f"{self._folder}.pkl in it is damaged (more than one value)")
        check_plain(value)
        return value

    def push(self, value: object) -> None:
        """Put a value on the stack."""
        self._stack.append(value)

    def pop(self, count: int) -> list[object]:
        """Take values off the stack."""
        taken = self._stack[-count:]
        if len(taken) < count or any(value is _STACK_MARK for value in taken):
            raise ValueError("too few values")
        del self._stack[-count:]
        return taken

    def pop_marked(self) -> list[object]:
        """Take what lies above the last mark off the stack, and the mark."""
        taken: list[object] = []
        while (value := self._stack.pop()) is not _STACK_MARK:
            taken.append(value)
        return taken[::-1]

    def put(self, index: int) -> None:
        """Remember the topmost value; torch counts up, and makes room for any number."""
        if index != len(self._memo) or self._stack[-1] is _STACK_MARK:
            raise ModelError(f"{self._folder}.pkl in it is damaged (a memory of {index})")
        self._memo.append(self._stack[-1])

    def get(self, index: int) -> None:
        """Put a remembered value on the stack."""
        self.push(self._memo[index])

    def fill(self, items: list[object]) -> None:
        """Put pairs into the topmost dictionary, or values into the topmost list."""
        target = self._stack[-1]
        if isinstance(target, list):
            target += items
            return
        if (
            not isinstance(target, dict)
            or len(items) % 2
            or not all(isinstance(key, str) for key in items[::2])
        ):
            raise ValueError("no list or dictionary")
        target.update(zip(items[::2], items[1::2], strict=True))

    def name(self, text: str) -> None:
        """Put a class or function on the stack that only :meth:`call` and :meth:`make` understand."""
        known = text in _CALLS or _STORAGE.fullmatch(text) or _CLASS.fullmatch(text)
        if not known:
            raise ModelError(f"names {text[:80]} in it, which no network needs")
        self.push(PickledName(text))

    def make(self) -> None:
        """Make an object of a class of the archive."""
        kind, arguments = self.pop(2)
        if not isinstance(kind, PickledName) or not _CLASS.fullmatch(kind.text) or arguments != ():
            raise ValueError("no class")
        self.push(Object(kind.text.replace(" ", ".")))

    def build(self) -> None:
        """Give an object its attributes."""
        (state,) = self.pop(1)
        made = self._stack[-1]
        if not isinstance(made, Object) or made.attributes is not None or not isinstance(state, dict):
            raise ValueError("no object")
        made.attributes = state

    def call(self) -> None:
        """Call one of torch's functions."""
        function, arguments = self.pop(2)
        if not isinstance(function, PickledName) or not isinstance(arguments, tuple):
            raise ValueError("no call")
        self.push(_CALLS[function.text](self, *arguments))

    def storage(self) -> None:
        """Look up a tensor's memory."""
        (given,) = self.pop(1)
        match given:
            case ("storage", PickledName(text), str(key), str(device), int(count)) if _DEVICE.fullmatch(
                device
            ):
                item = _STORAGE_ITEM_SIZES[_STORAGE.fullmatch(text)[1]]  # type: ignore[index]
            case _:
                raise ValueError("no storage")
        if len(self._members.get(f"{self._folder}/{key}", b"")) != item * count:
            raise ModelError(f"{self._folder}/{key} in it is cut short")
        self.push(Storage(count, item))

    def tensor(
        self, storage: object, offset: object, size: object, stride: object, gradient: object, hooks: object
    ) -> Tensor:
        """Return a tensor that lies within its memory."""
        if not isinstance(storage, Storage) or not isinstance(gradient, bool) or hooks != {}:
            raise ValueError("no tensor")
        sizes, strides = _naturals(size), _naturals(stride)
        (first,) = _naturals((offset,))
        elements, last = 1, first
        for count, step in zip(sizes, strides, strict=True):
            elements *= count
            last += (count - 1) * step
        if elements and last >= storage.count:
            raise ModelError(f"{self._folder}.pkl in it has a tensor that is larger than its weights")
        self.size += elements * storage.item
        if self.size > MAX_MODEL_SIZE or len(sizes) > 8:
            raise ModelError("holds more than a model does")
        return Tensor(elements * storage.item)


def _naturals(numbers: object) -> list[int]:
    if not isinstance(numbers, tuple):
        raise ValueError("no sizes")
    found = [number for number in numbers if type(number) is int and 0 <= number < 2**31]
    if len(found) != len(numbers):
        raise ValueError("no sizes")
    return found


def _list_of(kind: type) -> Callable[[_Machine, object], object]:
    def build(_: _Machine, values: object) -> object:
        if not isinstance(values, list) or any(type(value) is not kind for value in values):
            raise ValueError(f"no list of {kind.__name__}")
        return values

    return build


def _tagged(_: _Machine, value: object, tag: object) -> object:
    if not isinstance(value, list | dict) or not isinstance(tag, str) or not _TAG.fullmatch(tag):
        raise ValueError("no type")
    if tag.count("[") > 5:
        raise ValueError("no type")
    return value


_CALLS: Mapping[str, Callable[..., object]] = {
    "torch._utils _rebuild_tensor_v2": _Machine.tensor,
    "collections OrderedDict": lambda _: {},
    "torch.jit._pickle build_tensorlist": _list_of(Tensor),
    "torch.jit._pickle restore_type_tag": _tagged,
    **{f"torch.jit._pickle {name}": _list_of(kind) for name, kind in _LIST_BUILDERS.items()},
}

_OPCODE_STEPS: Mapping[str, Callable[[_Machine, Any], None]] = {
    "PROTO": lambda _machine, _version: None,
    "STOP": lambda _machine, _nothing: None,
    "MARK": lambda machine, _: machine.push(_STACK_MARK),
    "NONE": lambda machine, _: machine.push(None),
    "NEWTRUE": lambda machine, _: machine.push(True),
    "NEWFALSE": lambda machine, _: machine.push(False),
    "EMPTY_TUPLE": lambda machine, _: machine.push(()),
    "EMPTY_LIST": lambda machine, _: machine.push([]),
    "EMPTY_DICT": lambda machine, _: machine.push({}),
    "TUPLE": lambda machine, _: machine.push(tuple(machine.pop_marked())),
    "TUPLE1": lambda machine, _: machine.push(tuple(machine.pop(1))),
    "TUPLE2": lambda machine, _: machine.push(tuple(machine.pop(2))),
    "TUPLE3": lambda machine, _: machine.push(tuple(machine.pop(3))),
    "APPEND": lambda machine, _: machine.fill(machine.pop(1)),
    "APPENDS": lambda machine, _: machine.fill(machine.pop_marked()),
    "SETITEM": lambda machine, _: machine.fill(machine.pop(2)),
    "SETITEMS": lambda machine, _: machine.fill(machine.pop_marked()),
    "BININT": lambda machine, value: machine.push(value),
    "BININT1": lambda machine, value: machine.push(value),
    "BININT2": lambda machine, value: machine.push(value),
    "LONG1": lambda machine, value: machine.push(value),
    "BINFLOAT": lambda machine, value: machine.push(value),
    "BINUNICODE": lambda machine, value: machine.push(value),
    "BINPUT": lambda machine, index: machine.put(index),
    "LONG_BINPUT": lambda machine, index: machine.put(index),
    "BINGET": lambda machine, index: machine.get(index),
    "LONG_BINGET": lambda machine, index: machine.get(index),
    "GLOBAL": lambda machine, text: machine.name(text),
    "NEWOBJ": lambda machine, _: machine.make(),
    "BUILD": lambda machine, _: machine.build(),
    "REDUCE": lambda machine, _: machine.call(),
    "BINPERSID": lambda machine, _: machine.storage(),
}
"""What torch's pickler writes."""
