"""The league's messages, as published: ``SSL_WrapperPacket``, ``grSim_Packet``, ``RobotControl``, ...

The classes are made from the descriptors that the build compiles from
``proto/*.proto``. They live in a pool of their own, so that another package
that defines messages of the same names can be used in the same process.
"""

from __future__ import annotations

from importlib.resources import files
from typing import TYPE_CHECKING, Any

from google.protobuf.descriptor_pb2 import FileDescriptorSet
from google.protobuf.descriptor_pool import DescriptorPool
from google.protobuf.message import DecodeError, EncodeError, Message
from google.protobuf.message_factory import GetMessageClass

if TYPE_CHECKING:
    from robobt.league.wire.proto.grSim_Commands_pb2 import grSim_Commands, grSim_Robot_Command
    from robobt.league.wire.proto.grSim_Packet_pb2 import grSim_Packet
    from robobt.league.wire.proto.grSim_Replacement_pb2 import (
        grSim_BallReplacement,
        grSim_Replacement,
        grSim_RobotReplacement,
    )
    from robobt.league.wire.proto.grSim_Robotstatus_pb2 import Robot_Status, Robots_Status
    from robobt.league.wire.proto.ssl_gc_common_pb2 import RobotId
    from robobt.league.wire.proto.ssl_gc_game_event_pb2 import GameEvent
    from robobt.league.wire.proto.ssl_gc_geometry_pb2 import Vector2, Vector3
    from robobt.league.wire.proto.ssl_gc_referee_message_pb2 import GameEventProposalGroup, Referee
    from robobt.league.wire.proto.ssl_simulation_config_pb2 import (
        RealismConfig,
        RobotLimits,
        RobotSpecs,
        RobotWheelAngles,
        SimulatorConfig,
    )
    from robobt.league.wire.proto.ssl_simulation_control_pb2 import (
        SimulatorCommand,
        SimulatorControl,
        SimulatorResponse,
        TeleportBall,
        TeleportRobot,
    )
    from robobt.league.wire.proto.ssl_simulation_custom_erforce_realism_pb2 import RealismConfigErForce
    from robobt.league.wire.proto.ssl_simulation_custom_erforce_robot_spec_pb2 import RobotSpecErForce
    from robobt.league.wire.proto.ssl_simulation_error_pb2 import SimulatorError
    from robobt.league.wire.proto.ssl_simulation_robot_control_pb2 import (
        MoveGlobalVelocity,
        MoveLocalVelocity,
        MoveWheelVelocity,
        RobotCommand,
        RobotControl,
        RobotMoveCommand,
    )
    from robobt.league.wire.proto.ssl_simulation_robot_feedback_pb2 import RobotControlResponse, RobotFeedback
    from robobt.league.wire.proto.ssl_simulation_synchronous_pb2 import (
        SimulationSyncRequest,
        SimulationSyncResponse,
    )
    from robobt.league.wire.proto.ssl_vision_detection_pb2 import (
        SSL_DetectionBall,
        SSL_DetectionFrame,
        SSL_DetectionRobot,
    )
    from robobt.league.wire.proto.ssl_vision_detection_tracked_pb2 import (
        KickedBall,
        TrackedBall,
        TrackedFrame,
        TrackedRobot,
    )
    from robobt.league.wire.proto.ssl_vision_geometry_pb2 import (
        SSL_BallModelChipFixedLoss,
        SSL_BallModelStraightTwoPhase,
        SSL_FieldCircularArc,
        SSL_FieldLineSegment,
        SSL_GeometryCameraCalibration,
        SSL_GeometryData,
        SSL_GeometryFieldSize,
        SSL_GeometryModels,
        Vector2f,
    )
    from robobt.league.wire.proto.ssl_vision_wrapper_pb2 import SSL_WrapperPacket
    from robobt.league.wire.proto.ssl_vision_wrapper_tracked_pb2 import TrackerWrapperPacket
else:

    def _load() -> dict[str, Any]:
        """Every message class by its name.

        Raises:
            ImportError: the package was not built, so that there are no descriptors.
        """
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
            message.name: GetMessageClass(pool.FindMessageTypeByName(_full_name(file, message)))
            for file in compiled.file
            for message in file.message_type
        }

    def _full_name(file: Any, message: Any) -> str:
        return f"{file.package}.{message.name}" if file.package else message.name

    globals().update(_load())

__all__ = [
    "DecodeError",
    "EncodeError",
    "GameEvent",
    "GameEventProposalGroup",
    "KickedBall",
    "Message",
    "MoveGlobalVelocity",
    "MoveLocalVelocity",
    "MoveWheelVelocity",
    "RealismConfig",
    "RealismConfigErForce",
    "Referee",
    "RobotCommand",
    "RobotControl",
    "RobotControlResponse",
    "RobotFeedback",
    "RobotId",
    "RobotLimits",
    "RobotMoveCommand",
    "RobotSpecErForce",
    "RobotSpecs",
    "RobotWheelAngles",
    "Robot_Status",
    "Robots_Status",
    "SSL_BallModelChipFixedLoss",
    "SSL_BallModelStraightTwoPhase",
    "SSL_DetectionBall",
    "SSL_DetectionFrame",
    "SSL_DetectionRobot",
    "SSL_FieldCircularArc",
    "SSL_FieldLineSegment",
    "SSL_GeometryCameraCalibration",
    "SSL_GeometryData",
    "SSL_GeometryFieldSize",
    "SSL_GeometryModels",
    "SSL_WrapperPacket",
    "SimulationSyncRequest",
    "SimulationSyncResponse",
    "SimulatorCommand",
    "SimulatorConfig",
    "SimulatorControl",
    "SimulatorError",
    "SimulatorResponse",
    "TeleportBall",
    "TeleportRobot",
    "TrackedBall",
    "TrackedFrame",
    "TrackedRobot",
    "TrackerWrapperPacket",
    "Vector2",
    "Vector2f",
    "Vector3",
    "grSim_BallReplacement",
    "grSim_Commands",
    "grSim_Packet",
    "grSim_Replacement",
    "grSim_RobotReplacement",
    "grSim_Robot_Command",
]
