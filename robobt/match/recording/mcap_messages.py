"""Messages of our own in MCAP files: a tree's statuses, and numbers that skills publish."""

from __future__ import annotations

from typing import Any

from google.protobuf.descriptor_pb2 import FieldDescriptorProto, FileDescriptorProto
from google.protobuf.descriptor_pool import DescriptorPool
from google.protobuf.message_factory import GetMessageClass
from google.protobuf.timestamp_pb2 import DESCRIPTOR as TIMESTAMP

_PROTO_PACKAGE = "robobt"

_TYPES = {
    "string": FieldDescriptorProto.TYPE_STRING,
    "bool": FieldDescriptorProto.TYPE_BOOL,
    "double": FieldDescriptorProto.TYPE_DOUBLE,
}

_STATUS_ENUM = ("NONE", "RUNNING", "SUCCESS", "FAILURE")

_MESSAGES = {
    "NodeStatus": {
        "path": "string",
        "name": "string",
        "type": "string",
        "status": "enum robobt.Status",
        "ticked": "bool",
        "reason": "string",
    },
    "TreeStatus": {"timestamp": "google.protobuf.Timestamp", "nodes": "repeated robobt.NodeStatus"},
    "Number": {
        "timestamp": "google.protobuf.Timestamp",
        "layer": "string",
        "name": "string",
        "value": "double",
    },
}
"""By message the types of its fields; they are numbered from 1 in this order, which is never to change."""


def stamp(time: int) -> dict[str, int]:
    """Return a time [ns] as the fields of a Protocol Buffers timestamp."""
    seconds, nanos = divmod(time, 1_000_000_000)
    return {"seconds": seconds, "nanos": nanos}


def _file() -> FileDescriptorProto:
    file = FileDescriptorProto(name="robobt/recording.proto", package=_PROTO_PACKAGE, syntax="proto3")
    file.dependency.append(TIMESTAMP.name)
    status = file.enum_type.add(name="Status")
    for number, name in enumerate(_STATUS_ENUM):
        status.value.add(name=name, number=number)
    for name, entries in _MESSAGES.items():
        message = file.message_type.add(name=name)
        for number, (field, kind) in enumerate(entries.items(), 1):
            added = message.field.add(name=field, number=number, label=FieldDescriptorProto.LABEL_OPTIONAL)
            how, _, other = kind.rpartition(" ")
            if how == "repeated":
                added.label = FieldDescriptorProto.LABEL_REPEATED
            if kind in _TYPES:
                added.type = _TYPES[kind]
            else:
                added.type = (
                    FieldDescriptorProto.TYPE_ENUM if how == "enum" else FieldDescriptorProto.TYPE_MESSAGE
                )
                added.type_name = f".{other}"
    return file


def _class(name: str) -> Any:
    return GetMessageClass(_POOL.FindMessageTypeByName(f"{_PROTO_PACKAGE}.{name}"))


# A pool of our own, so that nobody's messages get in the way.
_POOL = DescriptorPool()
_POOL.AddSerializedFile(TIMESTAMP.serialized_pb)
_POOL.Add(_file())

TREE_STATUS = _class("TreeStatus")
"""The class of a message with every node of a tree: id, name, type, status, whether it ran, its reason."""

NUMBER = _class("Number")
"""The class of a message with a number that a skill published: layer, name, value."""
