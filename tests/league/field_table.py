"""The fields of the league's messages as its interface tables give them: label, type, name, number."""

MESSAGES = """
SSL_WrapperPacket
    opt SSL_DetectionFrame detection = 1
    opt SSL_GeometryData geometry = 2
    opt SSL_Source source = 3
SSL_DetectionBall
    req float confidence = 1
    opt uint32 area = 2
    req float x = 3
    req float y = 4
    opt float z = 5
    req float pixel_x = 6
    req float pixel_y = 7
SSL_DetectionRobot
    req float confidence = 1
    opt uint32 robot_id = 2
    req float x = 3
    req float y = 4
    opt float orientation = 5
    req float pixel_x = 6
    req float pixel_y = 7
    opt float height = 8
SSL_DetectionFrame
    req uint32 frame_number = 1
    req double t_capture = 2
    req double t_sent = 3
    opt double t_capture_camera = 8
    req uint32 camera_id = 4
    rep SSL_DetectionBall balls = 5
    rep SSL_DetectionRobot robots_yellow = 6
    rep SSL_DetectionRobot robots_blue = 7
Vector2f
    req float x = 1
    req float y = 2
SSL_FieldLineSegment
    req string name = 1
    req Vector2f p1 = 2
    req Vector2f p2 = 3
    req float thickness = 4
    opt SSL_FieldShapeType type = 5
SSL_FieldCircularArc
    req string name = 1
    req Vector2f center = 2
    req float radius = 3
    req float a1 = 4
    req float a2 = 5
    req float thickness = 6
    opt SSL_FieldShapeType type = 7
SSL_GeometryFieldSize
    req int32 field_length = 1
    req int32 field_width = 2
    req int32 goal_width = 3
    req int32 goal_depth = 4
    req int32 boundary_width = 5
    opt int32 boundary_width_goal_line = 16
    rep SSL_FieldLineSegment field_lines = 6
    rep SSL_FieldCircularArc field_arcs = 7
    opt int32 penalty_area_depth = 8
    opt int32 penalty_area_width = 9
    opt int32 center_circle_radius = 10
    opt int32 line_thickness = 11
    opt int32 goal_center_to_penalty_mark = 12
    opt int32 goal_height = 13
    opt float ball_radius = 14
    opt float max_robot_radius = 15
    opt int32 goal_substitution_area_width = 17
SSL_GeometryCameraCalibration
    req uint32 camera_id = 1
    req float focal_length = 2
    req float principal_point_x = 3
    req float principal_point_y = 4
    req float distortion = 5
    req float q0 = 6
    req float q1 = 7
    req float q2 = 8
    req float q3 = 9
    req float tx = 10
    req float ty = 11
    req float tz = 12
    opt float derived_camera_world_tx = 13
    opt float derived_camera_world_ty = 14
    opt float derived_camera_world_tz = 15
    opt uint32 pixel_image_width = 16
    opt uint32 pixel_image_height = 17
SSL_BallModelStraightTwoPhase
    req double acc_slide = 1
    req double acc_roll = 2
    req double k_switch = 3
SSL_BallModelChipFixedLoss
    req double damping_xy_first_hop = 1
    req double damping_xy_other_hops = 2
    req double damping_z = 3
SSL_GeometryModels
    opt SSL_BallModelStraightTwoPhase straight_two_phase = 1
    opt SSL_BallModelChipFixedLoss chip_fixed_loss = 2
SSL_GeometryData
    req SSL_GeometryFieldSize field = 1
    rep SSL_GeometryCameraCalibration calib = 2
    opt SSL_GeometryModels models = 3
TrackerWrapperPacket
    req string uuid = 1
    opt string source_name = 2
    opt TrackedFrame tracked_frame = 3
TrackedBall
    req Vector3 pos = 1
    opt Vector3 vel = 2
    opt float visibility = 3
KickedBall
    req Vector2 pos = 1
    req Vector3 vel = 2
    req double start_timestamp = 3
    opt double stop_timestamp = 4
    opt Vector2 stop_pos = 5
    opt RobotId robot_id = 6
TrackedRobot
    req RobotId robot_id = 1
    req Vector2 pos = 2
    req float orientation = 3
    opt Vector2 vel = 4
    opt float vel_angular = 5
    opt float visibility = 6
TrackedFrame
    req uint32 frame_number = 1
    req double timestamp = 2
    rep TrackedBall balls = 3
    rep TrackedRobot robots = 4
    opt KickedBall kicked_ball = 5
    rep Capability capabilities = 6
Referee
    opt string source_identifier = 18
    opt MatchType match_type = 19
    req uint64 packet_timestamp = 1
    req Stage stage = 2
    opt sint64 stage_time_left = 3
    req Command command = 4
    req uint32 command_counter = 5
    req uint64 command_timestamp = 6
    req TeamInfo yellow = 7
    req TeamInfo blue = 8
    opt Point designated_position = 9
    opt bool blue_team_on_positive_half = 10
    opt Command next_command = 12
    rep GameEvent game_events = 16
    rep GameEventProposalGroup game_event_proposals = 17
    opt int64 current_action_time_remaining = 15
    opt string status_message = 20
Referee.TeamInfo
    req string name = 1
    req uint32 score = 2
    req uint32 red_cards = 3
    rep uint32 yellow_card_times = 4 packed
    req uint32 yellow_cards = 5
    req uint32 timeouts = 6
    req uint32 timeout_time = 7
    req uint32 goalkeeper = 8
    opt uint32 foul_counter = 9
    opt uint32 ball_placement_failures = 10
    opt bool can_place_ball = 12
    opt uint32 max_allowed_bots = 13
    opt bool bot_substitution_intent = 14
    opt bool ball_placement_failures_reached = 15
    opt bool bot_substitution_allowed = 16
    opt uint32 bot_substitutions_left = 17
    opt uint32 bot_substitution_time_left = 18
    opt HullColor hull_color = 19
Referee.Point
    req float x = 1
    req float y = 2
GameEventProposalGroup
    opt string id = 3
    rep GameEvent game_events = 1
    opt bool accepted = 2
RobotId
    opt uint32 id = 1
    opt Team team = 2
Vector2
    req float x = 1
    req float y = 2
Vector3
    req float x = 1
    req float y = 2
    req float z = 3
grSim_Packet
    opt grSim_Commands commands = 1
    opt grSim_Replacement replacement = 2
grSim_Robot_Command
    req uint32 id = 1
    req float kickspeedx = 2
    req float kickspeedz = 3
    req float veltangent = 4
    req float velnormal = 5
    req float velangular = 6
    req bool spinner = 7
    req bool wheelsspeed = 8
    opt float wheel1 = 9
    opt float wheel2 = 10
    opt float wheel3 = 11
    opt float wheel4 = 12
grSim_Commands
    req double timestamp = 1
    req bool isteamyellow = 2
    rep grSim_Robot_Command robot_commands = 3
grSim_RobotReplacement
    req double x = 1
    req double y = 2
    req double dir = 3
    req uint32 id = 4
    req bool yellowteam = 5
    opt bool turnon = 6
grSim_BallReplacement
    opt double x = 1
    opt double y = 2
    opt double vx = 3
    opt double vy = 4
grSim_Replacement
    opt grSim_BallReplacement ball = 1
    rep grSim_RobotReplacement robots = 2
Robots_Status
    rep Robot_Status robots_status = 1
Robot_Status
    req int32 robot_id = 1
    req bool infrared = 2
    req bool flat_kick = 3
    req bool chip_kick = 4
RobotCommand
    req uint32 id = 1
    opt RobotMoveCommand move_command = 2
    opt float kick_speed = 3
    opt float kick_angle = 4
    opt float dribbler_speed = 5
RobotMoveCommand
    one MoveWheelVelocity wheel_velocity = 1
    one MoveLocalVelocity local_velocity = 2
    one MoveGlobalVelocity global_velocity = 3
MoveWheelVelocity
    req float front_right = 1
    req float back_right = 2
    req float back_left = 3
    req float front_left = 4
MoveLocalVelocity
    req float forward = 1
    req float left = 2
    req float angular = 3
MoveGlobalVelocity
    req float x = 1
    req float y = 2
    req float angular = 3
RobotControl
    rep RobotCommand robot_commands = 1
RobotFeedback
    req uint32 id = 1
    opt bool dribbler_ball_contact = 2
    opt google.protobuf.Any custom = 3
RobotControlResponse
    rep SimulatorError errors = 1
    rep RobotFeedback feedback = 2
TeleportBall
    opt float x = 1
    opt float y = 2
    opt float z = 3
    opt float vx = 4
    opt float vy = 5
    opt float vz = 6
    opt bool teleport_safely = 7
    opt bool roll = 8
    opt bool by_force = 9
TeleportRobot
    req RobotId id = 1
    opt float x = 2
    opt float y = 3
    opt float orientation = 4
    opt float v_x = 5
    opt float v_y = 6
    opt float v_angular = 7
    opt bool present = 8
    opt bool by_force = 9
SimulatorControl
    opt TeleportBall teleport_ball = 1
    rep TeleportRobot teleport_robot = 2
    opt float simulation_speed = 3
SimulatorCommand
    opt SimulatorControl control = 1
    opt SimulatorConfig config = 2
SimulatorResponse
    rep SimulatorError errors = 1
RobotLimits
    opt float acc_speedup_absolute_max = 1
    opt float acc_speedup_angular_max = 2
    opt float acc_brake_absolute_max = 3
    opt float acc_brake_angular_max = 4
    opt float vel_absolute_max = 5
    opt float vel_angular_max = 6
RobotWheelAngles
    req float front_right = 1
    req float back_right = 2
    req float back_left = 3
    req float front_left = 4
RobotSpecs
    req RobotId id = 1
    opt float radius = 2
    opt float height = 3
    opt float mass = 4
    opt float max_linear_kick_speed = 7
    opt float max_chip_kick_speed = 8
    opt float center_to_dribbler = 9
    opt RobotLimits limits = 10
    opt RobotWheelAngles wheel_angles = 13
    rep google.protobuf.Any custom = 14
RealismConfig
    rep google.protobuf.Any custom = 1
SimulatorConfig
    opt SSL_GeometryData geometry = 1
    rep RobotSpecs robot_specs = 2
    opt RealismConfig realism_config = 3
    opt uint32 vision_port = 4
SimulatorError
    opt string code = 1
    opt string message = 2
SimulationSyncRequest
    opt float sim_step = 1
    opt SimulatorCommand simulator_command = 2
    opt RobotControl robot_control = 3
SimulationSyncResponse
    rep SSL_DetectionFrame detection = 1
    opt RobotControlResponse robot_control_response = 2
RealismConfigErForce
    opt float stddev_ball_p = 1
    opt float stddev_robot_p = 2
    opt float stddev_robot_phi = 3
    opt float stddev_ball_area = 4
    opt bool enable_invisible_ball = 5
    opt float ball_visibility_threshold = 6
    opt float camera_overlap = 7
    opt float dribbler_ball_detections = 8
    opt float camera_position_error = 9
    opt float robot_command_loss = 10
    opt float robot_response_loss = 11
    opt float missing_ball_detections = 12
    opt int64 vision_delay = 13
    opt int64 vision_processing_time = 14
    opt bool simulate_dribbling = 15
RobotSpecErForce
    opt float shoot_radius = 1
    opt float dribbler_width = 3
"""

ENUMS = """
SSL_Source
    SSL_SOURCE_UNKNOWN 0
    SSL_SOURCE_OTHER 1
    SSL_SOURCE_SSL_VISION 2
    SSL_SOURCE_VISION_PROCESSOR 3
    SSL_SOURCE_GRSIM 4
    SSL_SOURCE_ERFORCE_SIM 5
SSL_FieldShapeType
    Undefined 0
    CenterCircle 1
    TopTouchLine 2
    BottomTouchLine 3
    LeftGoalLine 4
    RightGoalLine 5
    HalfwayLine 6
    CenterLine 7
    LeftPenaltyStretch 8
    RightPenaltyStretch 9
    LeftFieldLeftPenaltyStretch 10
    LeftFieldRightPenaltyStretch 11
    RightFieldLeftPenaltyStretch 12
    RightFieldRightPenaltyStretch 13
Capability
    CAPABILITY_UNKNOWN 0
    CAPABILITY_DETECT_FLYING_BALLS 1
    CAPABILITY_DETECT_MULTIPLE_BALLS 2
    CAPABILITY_DETECT_KICKED_BALLS 3
Referee.Stage
    NORMAL_FIRST_HALF_PRE 0
    NORMAL_FIRST_HALF 1
    NORMAL_HALF_TIME 2
    NORMAL_SECOND_HALF_PRE 3
    NORMAL_SECOND_HALF 4
    EXTRA_TIME_BREAK 5
    EXTRA_FIRST_HALF_PRE 6
    EXTRA_FIRST_HALF 7
    EXTRA_HALF_TIME 8
    EXTRA_SECOND_HALF_PRE 9
    EXTRA_SECOND_HALF 10
    PENALTY_SHOOTOUT_BREAK 11
    PENALTY_SHOOTOUT 12
    POST_GAME 13
Referee.Command
    HALT 0
    STOP 1
    NORMAL_START 2
    FORCE_START 3
    PREPARE_KICKOFF_YELLOW 4
    PREPARE_KICKOFF_BLUE 5
    PREPARE_PENALTY_YELLOW 6
    PREPARE_PENALTY_BLUE 7
    DIRECT_FREE_YELLOW 8
    DIRECT_FREE_BLUE 9
    INDIRECT_FREE_YELLOW 10
    INDIRECT_FREE_BLUE 11
    TIMEOUT_YELLOW 12
    TIMEOUT_BLUE 13
    GOAL_YELLOW 14
    GOAL_BLUE 15
    BALL_PLACEMENT_YELLOW 16
    BALL_PLACEMENT_BLUE 17
MatchType
    UNKNOWN_MATCH 0
    GROUP_PHASE 1
    ELIMINATION_PHASE 2
    FRIENDLY 3
HullColor
    HULL_COLOR_UNKNOWN 0
    HULL_COLOR_DARK 1
    HULL_COLOR_LIGHT 2
Team
    UNKNOWN 0
    YELLOW 1
    BLUE 2
Division
    DIV_UNKNOWN 0
    DIV_A 1
    DIV_B 2
"""
