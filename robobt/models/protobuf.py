"""As much of Protocol Buffers as it takes to find and append a field of an ONNX file.

onnx itself would parse, and so trust, the whole file before its checksum has been compared.
"""

from __future__ import annotations

from collections.abc import Iterator

_MAX_FIELDS = 10_000


def fields(data: bytes) -> Iterator[tuple[int, int, bytes]]:
    """Yield number, start and content of each field of a message.

    Raises:
        ValueError: the bytes are no message.
    """
    place = 0
    for _ in range(_MAX_FIELDS):
        if place == len(data):
            return
        begin = place
        key, place = _varint(data, place)
        number, kind = key >> 3, key & 7
        if kind == 0:
            _, end = _varint(data, place)
        elif kind == 1:
            end = place + 8
        elif kind == 2:
            length, place = _varint(data, place)
            end = place + length
        elif kind == 5:
            end = place + 4
        else:
            raise ValueError(_NO_MODEL_FILE)
        if number == 0 or end > len(data):
            raise ValueError(_NO_MODEL_FILE)
        yield number, begin, data[place:end]
        place = end
    raise ValueError("holds more than a model does")


def field(number: int, content: bytes) -> bytes:
    """Encode a field of bytes."""
    return _encoded(number << 3 | 2) + _encoded(len(content)) + content


def _varint(data: bytes, place: int) -> tuple[int, int]:
    value = 0
    for shift in range(0, 70, 7):
        if place >= len(data):
            break
        byte = data[place]
        place += 1
        value |= (byte & 0x7F) << shift
        if byte < 0x80:
            return value, place
    raise ValueError(_NO_MODEL_FILE)


def _encoded(value: int) -> bytes:
    out = bytearray()
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


_NO_MODEL_FILE = "is neither a TorchScript archive nor an ONNX file, or is cut short"
