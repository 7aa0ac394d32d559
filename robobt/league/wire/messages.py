"""The league's messages, as published: ``SSL_WrapperPacket``, ``grSim_Packet``, ``RobotControl``, ...

The classes are created from the descriptors that the build compiles from
``proto/*.proto``. They live in their own descriptor pool, so that another package
that defines messages of the same names can be used in the same process.
"""
# ruff: noqa: F403 (the stubs exist for type checkers only)

from __future__ import annotations

from importlib.resources import files
from typing import TYPE_CHECKING

from google.protobuf.descriptor_pb2 import FileDescriptorSet
from google.protobuf.descriptor_pool import DescriptorPool
from google.protobuf.message import DecodeError as DecodeError
from google.protobuf.message import EncodeError as EncodeError
from google.protobuf.message import Message as Message
from google.protobuf.message_factory import GetMessageClass

if TYPE_CHECKING:
    from robobt.league.wire.proto.grSim_Commands_pb2 import *
    from robobt.league.wire.proto.grSim_Packet_pb2 import *
    from robobt.league.wire.proto.grSim_Replacement_pb2 import *
    from robobt.league.wire.proto.grSim_Robotstatus_pb2 import *
    from robobt.league.wire.proto.ssl_gc_api_pb2 import *
    from robobt.league.wire.proto.ssl_gc_change_pb2 import *
    from robobt.league.wire.proto.ssl_gc_ci_pb2 import *
    from robobt.league.wire.proto.ssl_gc_common_pb2 import *
    from robobt.league.wire.proto.ssl_gc_engine_config_pb2 import *
    from robobt.league.wire.proto.ssl_gc_game_event_pb2 import *
    from robobt.league.wire.proto.ssl_gc_geometry_pb2 import *
    from robobt.league.wire.proto.ssl_gc_rcon_pb2 import *
    from robobt.league.wire.proto.ssl_gc_referee_message_pb2 import *
    from robobt.league.wire.proto.ssl_gc_state_pb2 import *
    from robobt.league.wire.proto.ssl_simulation_config_pb2 import *
    from robobt.league.wire.proto.ssl_simulation_control_pb2 import *
    from robobt.league.wire.proto.ssl_simulation_custom_erforce_realism_pb2 import *
    from robobt.league.wire.proto.ssl_simulation_custom_erforce_robot_spec_pb2 import *
    from robobt.league.wire.proto.ssl_simulation_error_pb2 import *
    from robobt.league.wire.proto.ssl_simulation_robot_control_pb2 import *
    from robobt.league.wire.proto.ssl_simulation_robot_feedback_pb2 import *
    from robobt.league.wire.proto.ssl_simulation_synchronous_pb2 import *
    from robobt.league.wire.proto.ssl_vision_detection_pb2 import *
    from robobt.league.wire.proto.ssl_vision_detection_tracked_pb2 import *
    from robobt.league.wire.proto.ssl_vision_geometry_pb2 import *
    from robobt.league.wire.proto.ssl_vision_wrapper_pb2 import *
    from robobt.league.wire.proto.ssl_vision_wrapper_tracked_pb2 import *
else:

    def _load() -> dict[str, type[Message]]:
        """Return every message class by its name."""
        path = files("robobt.league.wire") / "proto" / "messages.desc"
        try:
            compiled = FileDescriptorSet.FromString(path.read_bytes())
        except FileNotFoundError as error:
            raise ImportError(
                "the league's messages are not compiled: install robobt (pip install -e .)"
            ) from error
        pool = DescriptorPool()
        for file in compiled.file:
            pool.Add(file)
        return {
            message.name: GetMessageClass(
                pool.FindMessageTypeByName(f"{file.package}.{message.name}".lstrip("."))
            )
            for file in compiled.file
            for message in file.message_type
        }

    globals().update(_load())
