from google.protobuf import struct_pb2 as _struct_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable, Mapping as _Mapping
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Reasoning(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    REASONING_UNSPECIFIED: _ClassVar[Reasoning]
    REASONING_V1: _ClassVar[Reasoning]
    REASONING_V2: _ClassVar[Reasoning]

class RuleSet(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    RULE_SET_UNSPECIFIED: _ClassVar[RuleSet]
    RULE_SET_THESIS: _ClassVar[RuleSet]
    RULE_SET_DEFAULT: _ClassVar[RuleSet]

class Input(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    INPUT_UNSPECIFIED: _ClassVar[Input]
    INPUT_SCENE: _ClassVar[Input]
    INPUT_OBJECT: _ClassVar[Input]

class Method(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    METHOD_UNSPECIFIED: _ClassVar[Method]
    METHOD_PARTS: _ClassVar[Method]
    METHOD_EMS: _ClassVar[Method]

class Believed(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    BELIEVED_UNSPECIFIED: _ClassVar[Believed]
    BELIEVED_PRIMITIVES: _ClassVar[Believed]
    BELIEVED_REFLECTED: _ClassVar[Believed]

class Rehearsing(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    REHEARSING_UNSPECIFIED: _ClassVar[Rehearsing]
    REHEARSING_AUTO: _ClassVar[Rehearsing]
    REHEARSING_NEVER: _ClassVar[Rehearsing]
    REHEARSING_ALWAYS: _ClassVar[Rehearsing]

class ShapeClass(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    SHAPE_CLASS_UNSPECIFIED: _ClassVar[ShapeClass]
    SHAPE_CLASS_CUBOID: _ClassVar[ShapeClass]
    SHAPE_CLASS_CYLINDER: _ClassVar[ShapeClass]
    SHAPE_CLASS_SPHERE: _ClassVar[ShapeClass]

class Actor(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    ACTOR_UNSPECIFIED: _ClassVar[Actor]
    ACTOR_ARM: _ClassVar[Actor]
    ACTOR_HAND: _ClassVar[Actor]

class Outcome(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    OUTCOME_UNSPECIFIED: _ClassVar[Outcome]
    OUTCOME_LIFTED: _ClassVar[Outcome]
    OUTCOME_HELD: _ClassVar[Outcome]
    OUTCOME_UNREACHABLE: _ClassVar[Outcome]
    OUTCOME_COLLISION_WITH_TABLE: _ClassVar[Outcome]
    OUTCOME_PUSHED_AWAY: _ClassVar[Outcome]
    OUTCOME_MISSED: _ClassVar[Outcome]
    OUTCOME_SLIPPED_IN_LIFT: _ClassVar[Outcome]
    OUTCOME_SLIPPED_IN_SHAKE: _ClassVar[Outcome]
REASONING_UNSPECIFIED: Reasoning
REASONING_V1: Reasoning
REASONING_V2: Reasoning
RULE_SET_UNSPECIFIED: RuleSet
RULE_SET_THESIS: RuleSet
RULE_SET_DEFAULT: RuleSet
INPUT_UNSPECIFIED: Input
INPUT_SCENE: Input
INPUT_OBJECT: Input
METHOD_UNSPECIFIED: Method
METHOD_PARTS: Method
METHOD_EMS: Method
BELIEVED_UNSPECIFIED: Believed
BELIEVED_PRIMITIVES: Believed
BELIEVED_REFLECTED: Believed
REHEARSING_UNSPECIFIED: Rehearsing
REHEARSING_AUTO: Rehearsing
REHEARSING_NEVER: Rehearsing
REHEARSING_ALWAYS: Rehearsing
SHAPE_CLASS_UNSPECIFIED: ShapeClass
SHAPE_CLASS_CUBOID: ShapeClass
SHAPE_CLASS_CYLINDER: ShapeClass
SHAPE_CLASS_SPHERE: ShapeClass
ACTOR_UNSPECIFIED: Actor
ACTOR_ARM: Actor
ACTOR_HAND: Actor
OUTCOME_UNSPECIFIED: Outcome
OUTCOME_LIFTED: Outcome
OUTCOME_HELD: Outcome
OUTCOME_UNREACHABLE: Outcome
OUTCOME_COLLISION_WITH_TABLE: Outcome
OUTCOME_PUSHED_AWAY: Outcome
OUTCOME_MISSED: Outcome
OUTCOME_SLIPPED_IN_LIFT: Outcome
OUTCOME_SLIPPED_IN_SHAKE: Outcome

class Nothing(_message.Message):
    __slots__ = ()
    def __init__(self) -> None: ...

class Vector3(_message.Message):
    __slots__ = ("x", "y", "z")
    X_FIELD_NUMBER: _ClassVar[int]
    Y_FIELD_NUMBER: _ClassVar[int]
    Z_FIELD_NUMBER: _ClassVar[int]
    x: float
    y: float
    z: float
    def __init__(self, x: _Optional[float] = ..., y: _Optional[float] = ..., z: _Optional[float] = ...) -> None: ...

class Quaternion(_message.Message):
    __slots__ = ("x", "y", "z", "w")
    X_FIELD_NUMBER: _ClassVar[int]
    Y_FIELD_NUMBER: _ClassVar[int]
    Z_FIELD_NUMBER: _ClassVar[int]
    W_FIELD_NUMBER: _ClassVar[int]
    x: float
    y: float
    z: float
    w: float
    def __init__(self, x: _Optional[float] = ..., y: _Optional[float] = ..., z: _Optional[float] = ..., w: _Optional[float] = ...) -> None: ...

class Pose(_message.Message):
    __slots__ = ("position", "quaternion")
    POSITION_FIELD_NUMBER: _ClassVar[int]
    QUATERNION_FIELD_NUMBER: _ClassVar[int]
    position: Vector3
    quaternion: Quaternion
    def __init__(self, position: _Optional[_Union[Vector3, _Mapping]] = ..., quaternion: _Optional[_Union[Quaternion, _Mapping]] = ...) -> None: ...

class SupportPlane(_message.Message):
    __slots__ = ("normal", "offset", "inliers", "residual_mm")
    NORMAL_FIELD_NUMBER: _ClassVar[int]
    OFFSET_FIELD_NUMBER: _ClassVar[int]
    INLIERS_FIELD_NUMBER: _ClassVar[int]
    RESIDUAL_MM_FIELD_NUMBER: _ClassVar[int]
    normal: Vector3
    offset: float
    inliers: int
    residual_mm: float
    def __init__(self, normal: _Optional[_Union[Vector3, _Mapping]] = ..., offset: _Optional[float] = ..., inliers: _Optional[int] = ..., residual_mm: _Optional[float] = ...) -> None: ...

class PointCloud(_message.Message):
    __slots__ = ("float32", "float64")
    FLOAT32_FIELD_NUMBER: _ClassVar[int]
    FLOAT64_FIELD_NUMBER: _ClassVar[int]
    float32: bytes
    float64: bytes
    def __init__(self, float32: _Optional[bytes] = ..., float64: _Optional[bytes] = ...) -> None: ...

class DepthImage(_message.Message):
    __slots__ = ("height", "width", "uint16", "float32", "float64", "intrinsics", "depth_scale")
    HEIGHT_FIELD_NUMBER: _ClassVar[int]
    WIDTH_FIELD_NUMBER: _ClassVar[int]
    UINT16_FIELD_NUMBER: _ClassVar[int]
    FLOAT32_FIELD_NUMBER: _ClassVar[int]
    FLOAT64_FIELD_NUMBER: _ClassVar[int]
    INTRINSICS_FIELD_NUMBER: _ClassVar[int]
    DEPTH_SCALE_FIELD_NUMBER: _ClassVar[int]
    height: int
    width: int
    uint16: bytes
    float32: bytes
    float64: bytes
    intrinsics: _containers.RepeatedScalarFieldContainer[float]
    depth_scale: float
    def __init__(self, height: _Optional[int] = ..., width: _Optional[int] = ..., uint16: _Optional[bytes] = ..., float32: _Optional[bytes] = ..., float64: _Optional[bytes] = ..., intrinsics: _Optional[_Iterable[float]] = ..., depth_scale: _Optional[float] = ...) -> None: ...

class CloudFile(_message.Message):
    __slots__ = ("name", "content", "intrinsics", "depth_scale")
    NAME_FIELD_NUMBER: _ClassVar[int]
    CONTENT_FIELD_NUMBER: _ClassVar[int]
    INTRINSICS_FIELD_NUMBER: _ClassVar[int]
    DEPTH_SCALE_FIELD_NUMBER: _ClassVar[int]
    name: str
    content: bytes
    intrinsics: _containers.RepeatedScalarFieldContainer[float]
    depth_scale: float
    def __init__(self, name: _Optional[str] = ..., content: _Optional[bytes] = ..., intrinsics: _Optional[_Iterable[float]] = ..., depth_scale: _Optional[float] = ...) -> None: ...

class EmsParameters(_message.Message):
    __slots__ = ("outlier_ratio", "max_iterations", "tolerance", "relative_tolerance", "max_switches", "adaptive_upper_bound", "eps", "min_points")
    OUTLIER_RATIO_FIELD_NUMBER: _ClassVar[int]
    MAX_ITERATIONS_FIELD_NUMBER: _ClassVar[int]
    TOLERANCE_FIELD_NUMBER: _ClassVar[int]
    RELATIVE_TOLERANCE_FIELD_NUMBER: _ClassVar[int]
    MAX_SWITCHES_FIELD_NUMBER: _ClassVar[int]
    ADAPTIVE_UPPER_BOUND_FIELD_NUMBER: _ClassVar[int]
    EPS_FIELD_NUMBER: _ClassVar[int]
    MIN_POINTS_FIELD_NUMBER: _ClassVar[int]
    outlier_ratio: float
    max_iterations: int
    tolerance: float
    relative_tolerance: float
    max_switches: int
    adaptive_upper_bound: bool
    eps: float
    min_points: int
    def __init__(self, outlier_ratio: _Optional[float] = ..., max_iterations: _Optional[int] = ..., tolerance: _Optional[float] = ..., relative_tolerance: _Optional[float] = ..., max_switches: _Optional[int] = ..., adaptive_upper_bound: _Optional[bool] = ..., eps: _Optional[float] = ..., min_points: _Optional[int] = ...) -> None: ...

class GraspRequest(_message.Message):
    __slots__ = ("task", "points", "depth", "file", "reasoning", "rule_set", "input", "viewpoint", "target", "gripper", "max_grasps", "seed", "method", "recovery", "explain", "frame_id", "rejected", "rehearsal", "per_point")
    TASK_FIELD_NUMBER: _ClassVar[int]
    POINTS_FIELD_NUMBER: _ClassVar[int]
    DEPTH_FIELD_NUMBER: _ClassVar[int]
    FILE_FIELD_NUMBER: _ClassVar[int]
    REASONING_FIELD_NUMBER: _ClassVar[int]
    RULE_SET_FIELD_NUMBER: _ClassVar[int]
    INPUT_FIELD_NUMBER: _ClassVar[int]
    VIEWPOINT_FIELD_NUMBER: _ClassVar[int]
    TARGET_FIELD_NUMBER: _ClassVar[int]
    GRIPPER_FIELD_NUMBER: _ClassVar[int]
    MAX_GRASPS_FIELD_NUMBER: _ClassVar[int]
    SEED_FIELD_NUMBER: _ClassVar[int]
    METHOD_FIELD_NUMBER: _ClassVar[int]
    RECOVERY_FIELD_NUMBER: _ClassVar[int]
    EXPLAIN_FIELD_NUMBER: _ClassVar[int]
    FRAME_ID_FIELD_NUMBER: _ClassVar[int]
    REJECTED_FIELD_NUMBER: _ClassVar[int]
    REHEARSAL_FIELD_NUMBER: _ClassVar[int]
    PER_POINT_FIELD_NUMBER: _ClassVar[int]
    task: str
    points: PointCloud
    depth: DepthImage
    file: CloudFile
    reasoning: Reasoning
    rule_set: RuleSet
    input: Input
    viewpoint: Vector3
    target: Vector3
    gripper: str
    max_grasps: int
    seed: int
    method: Method
    recovery: EmsParameters
    explain: bool
    frame_id: str
    rejected: int
    rehearsal: Rehearsing
    per_point: bool
    def __init__(self, task: _Optional[str] = ..., points: _Optional[_Union[PointCloud, _Mapping]] = ..., depth: _Optional[_Union[DepthImage, _Mapping]] = ..., file: _Optional[_Union[CloudFile, _Mapping]] = ..., reasoning: _Optional[_Union[Reasoning, str]] = ..., rule_set: _Optional[_Union[RuleSet, str]] = ..., input: _Optional[_Union[Input, str]] = ..., viewpoint: _Optional[_Union[Vector3, _Mapping]] = ..., target: _Optional[_Union[Vector3, _Mapping]] = ..., gripper: _Optional[str] = ..., max_grasps: _Optional[int] = ..., seed: _Optional[int] = ..., method: _Optional[_Union[Method, str]] = ..., recovery: _Optional[_Union[EmsParameters, _Mapping]] = ..., explain: _Optional[bool] = ..., frame_id: _Optional[str] = ..., rejected: _Optional[int] = ..., rehearsal: _Optional[_Union[Rehearsing, str]] = ..., per_point: _Optional[bool] = ...) -> None: ...

class Deformation(_message.Message):
    __slots__ = ("taper", "bend")
    TAPER_FIELD_NUMBER: _ClassVar[int]
    BEND_FIELD_NUMBER: _ClassVar[int]
    taper: _containers.RepeatedScalarFieldContainer[float]
    bend: _containers.RepeatedScalarFieldContainer[float]
    def __init__(self, taper: _Optional[_Iterable[float]] = ..., bend: _Optional[_Iterable[float]] = ...) -> None: ...

class Primitive(_message.Message):
    __slots__ = ("id", "parameters", "shape_class", "shape_probability", "full_extents", "residual_mm", "support", "deformation", "holes", "labels")
    ID_FIELD_NUMBER: _ClassVar[int]
    PARAMETERS_FIELD_NUMBER: _ClassVar[int]
    SHAPE_CLASS_FIELD_NUMBER: _ClassVar[int]
    SHAPE_PROBABILITY_FIELD_NUMBER: _ClassVar[int]
    FULL_EXTENTS_FIELD_NUMBER: _ClassVar[int]
    RESIDUAL_MM_FIELD_NUMBER: _ClassVar[int]
    SUPPORT_FIELD_NUMBER: _ClassVar[int]
    DEFORMATION_FIELD_NUMBER: _ClassVar[int]
    HOLES_FIELD_NUMBER: _ClassVar[int]
    LABELS_FIELD_NUMBER: _ClassVar[int]
    id: int
    parameters: _containers.RepeatedScalarFieldContainer[float]
    shape_class: ShapeClass
    shape_probability: float
    full_extents: Vector3
    residual_mm: float
    support: int
    deformation: Deformation
    holes: int
    labels: _containers.RepeatedScalarFieldContainer[str]
    def __init__(self, id: _Optional[int] = ..., parameters: _Optional[_Iterable[float]] = ..., shape_class: _Optional[_Union[ShapeClass, str]] = ..., shape_probability: _Optional[float] = ..., full_extents: _Optional[_Union[Vector3, _Mapping]] = ..., residual_mm: _Optional[float] = ..., support: _Optional[int] = ..., deformation: _Optional[_Union[Deformation, _Mapping]] = ..., holes: _Optional[int] = ..., labels: _Optional[_Iterable[str]] = ...) -> None: ...

class Region(_message.Message):
    __slots__ = ("primitive_ids", "affordance", "confidence")
    PRIMITIVE_IDS_FIELD_NUMBER: _ClassVar[int]
    AFFORDANCE_FIELD_NUMBER: _ClassVar[int]
    CONFIDENCE_FIELD_NUMBER: _ClassVar[int]
    primitive_ids: _containers.RepeatedScalarFieldContainer[int]
    affordance: str
    confidence: float
    def __init__(self, primitive_ids: _Optional[_Iterable[int]] = ..., affordance: _Optional[str] = ..., confidence: _Optional[float] = ...) -> None: ...

class Reason(_message.Message):
    __slots__ = ("code", "message")
    CODE_FIELD_NUMBER: _ClassVar[int]
    MESSAGE_FIELD_NUMBER: _ClassVar[int]
    code: str
    message: str
    def __init__(self, code: _Optional[str] = ..., message: _Optional[str] = ...) -> None: ...

class Grasp(_message.Message):
    __slots__ = ("pose", "pregrasp", "retreat", "width", "score", "rehearsed")
    POSE_FIELD_NUMBER: _ClassVar[int]
    PREGRASP_FIELD_NUMBER: _ClassVar[int]
    RETREAT_FIELD_NUMBER: _ClassVar[int]
    WIDTH_FIELD_NUMBER: _ClassVar[int]
    SCORE_FIELD_NUMBER: _ClassVar[int]
    REHEARSED_FIELD_NUMBER: _ClassVar[int]
    pose: Pose
    pregrasp: Pose
    retreat: Pose
    width: float
    score: float
    rehearsed: _containers.RepeatedScalarFieldContainer[Outcome]
    def __init__(self, pose: _Optional[_Union[Pose, _Mapping]] = ..., pregrasp: _Optional[_Union[Pose, _Mapping]] = ..., retreat: _Optional[_Union[Pose, _Mapping]] = ..., width: _Optional[float] = ..., score: _Optional[float] = ..., rehearsed: _Optional[_Iterable[_Union[Outcome, str]]] = ...) -> None: ...

class Rehearsal(_message.Message):
    __slots__ = ("tried", "stopped")
    TRIED_FIELD_NUMBER: _ClassVar[int]
    STOPPED_FIELD_NUMBER: _ClassVar[int]
    tried: int
    stopped: str
    def __init__(self, tried: _Optional[int] = ..., stopped: _Optional[str] = ...) -> None: ...

class Rejection(_message.Message):
    __slots__ = ("code", "message")
    CODE_FIELD_NUMBER: _ClassVar[int]
    MESSAGE_FIELD_NUMBER: _ClassVar[int]
    code: str
    message: str
    def __init__(self, code: _Optional[str] = ..., message: _Optional[str] = ...) -> None: ...

class RejectedGrasp(_message.Message):
    __slots__ = ("pose", "width", "reason")
    POSE_FIELD_NUMBER: _ClassVar[int]
    WIDTH_FIELD_NUMBER: _ClassVar[int]
    REASON_FIELD_NUMBER: _ClassVar[int]
    pose: Pose
    width: float
    reason: Rejection
    def __init__(self, pose: _Optional[_Union[Pose, _Mapping]] = ..., width: _Optional[float] = ..., reason: _Optional[_Union[Rejection, _Mapping]] = ...) -> None: ...

class Condition(_message.Message):
    __slots__ = ("predicate", "primitive_id", "holds", "measured", "required", "margin", "unit")
    PREDICATE_FIELD_NUMBER: _ClassVar[int]
    PRIMITIVE_ID_FIELD_NUMBER: _ClassVar[int]
    HOLDS_FIELD_NUMBER: _ClassVar[int]
    MEASURED_FIELD_NUMBER: _ClassVar[int]
    REQUIRED_FIELD_NUMBER: _ClassVar[int]
    MARGIN_FIELD_NUMBER: _ClassVar[int]
    UNIT_FIELD_NUMBER: _ClassVar[int]
    predicate: str
    primitive_id: int
    holds: bool
    measured: str
    required: str
    margin: float
    unit: str
    def __init__(self, predicate: _Optional[str] = ..., primitive_id: _Optional[int] = ..., holds: _Optional[bool] = ..., measured: _Optional[str] = ..., required: _Optional[str] = ..., margin: _Optional[float] = ..., unit: _Optional[str] = ...) -> None: ...

class RuleTrace(_message.Message):
    __slots__ = ("rule", "holds", "bindings", "conditions")
    class BindingsEntry(_message.Message):
        __slots__ = ("key", "value")
        KEY_FIELD_NUMBER: _ClassVar[int]
        VALUE_FIELD_NUMBER: _ClassVar[int]
        key: str
        value: int
        def __init__(self, key: _Optional[str] = ..., value: _Optional[int] = ...) -> None: ...
    RULE_FIELD_NUMBER: _ClassVar[int]
    HOLDS_FIELD_NUMBER: _ClassVar[int]
    BINDINGS_FIELD_NUMBER: _ClassVar[int]
    CONDITIONS_FIELD_NUMBER: _ClassVar[int]
    rule: str
    holds: bool
    bindings: _containers.ScalarMap[str, int]
    conditions: _containers.RepeatedCompositeFieldContainer[Condition]
    def __init__(self, rule: _Optional[str] = ..., holds: _Optional[bool] = ..., bindings: _Optional[_Mapping[str, int]] = ..., conditions: _Optional[_Iterable[_Union[Condition, _Mapping]]] = ...) -> None: ...

class Explanation(_message.Message):
    __slots__ = ("text", "facts", "rules", "nearest_miss")
    TEXT_FIELD_NUMBER: _ClassVar[int]
    FACTS_FIELD_NUMBER: _ClassVar[int]
    RULES_FIELD_NUMBER: _ClassVar[int]
    NEAREST_MISS_FIELD_NUMBER: _ClassVar[int]
    text: str
    facts: _containers.RepeatedScalarFieldContainer[str]
    rules: _containers.RepeatedCompositeFieldContainer[RuleTrace]
    nearest_miss: RuleTrace
    def __init__(self, text: _Optional[str] = ..., facts: _Optional[_Iterable[str]] = ..., rules: _Optional[_Iterable[_Union[RuleTrace, _Mapping]]] = ..., nearest_miss: _Optional[_Union[RuleTrace, _Mapping]] = ...) -> None: ...

class Scene(_message.Message):
    __slots__ = ("plane", "up", "object_points", "clusters", "dropped", "method", "removed_as_overlap", "candidates", "rejected")
    class DroppedEntry(_message.Message):
        __slots__ = ("key", "value")
        KEY_FIELD_NUMBER: _ClassVar[int]
        VALUE_FIELD_NUMBER: _ClassVar[int]
        key: str
        value: int
        def __init__(self, key: _Optional[str] = ..., value: _Optional[int] = ...) -> None: ...
    class RejectedEntry(_message.Message):
        __slots__ = ("key", "value")
        KEY_FIELD_NUMBER: _ClassVar[int]
        VALUE_FIELD_NUMBER: _ClassVar[int]
        key: str
        value: int
        def __init__(self, key: _Optional[str] = ..., value: _Optional[int] = ...) -> None: ...
    PLANE_FIELD_NUMBER: _ClassVar[int]
    UP_FIELD_NUMBER: _ClassVar[int]
    OBJECT_POINTS_FIELD_NUMBER: _ClassVar[int]
    CLUSTERS_FIELD_NUMBER: _ClassVar[int]
    DROPPED_FIELD_NUMBER: _ClassVar[int]
    METHOD_FIELD_NUMBER: _ClassVar[int]
    REMOVED_AS_OVERLAP_FIELD_NUMBER: _ClassVar[int]
    CANDIDATES_FIELD_NUMBER: _ClassVar[int]
    REJECTED_FIELD_NUMBER: _ClassVar[int]
    plane: SupportPlane
    up: Vector3
    object_points: int
    clusters: int
    dropped: _containers.ScalarMap[str, int]
    method: Method
    removed_as_overlap: int
    candidates: int
    rejected: _containers.ScalarMap[str, int]
    def __init__(self, plane: _Optional[_Union[SupportPlane, _Mapping]] = ..., up: _Optional[_Union[Vector3, _Mapping]] = ..., object_points: _Optional[int] = ..., clusters: _Optional[int] = ..., dropped: _Optional[_Mapping[str, int]] = ..., method: _Optional[_Union[Method, str]] = ..., removed_as_overlap: _Optional[int] = ..., candidates: _Optional[int] = ..., rejected: _Optional[_Mapping[str, int]] = ...) -> None: ...

class PointLabels(_message.Message):
    __slots__ = ("primitive", "region")
    PRIMITIVE_FIELD_NUMBER: _ClassVar[int]
    REGION_FIELD_NUMBER: _ClassVar[int]
    primitive: bytes
    region: bytes
    def __init__(self, primitive: _Optional[bytes] = ..., region: _Optional[bytes] = ...) -> None: ...

class GraspAnswer(_message.Message):
    __slots__ = ("request_id", "task", "reasoning", "rule_set", "gripper", "seed", "frame_id", "found", "reason", "region", "alternatives", "primitives", "grasps", "explanation", "scene", "timings_ms", "points", "rejected", "rehearsal")
    class TimingsMsEntry(_message.Message):
        __slots__ = ("key", "value")
        KEY_FIELD_NUMBER: _ClassVar[int]
        VALUE_FIELD_NUMBER: _ClassVar[int]
        key: str
        value: float
        def __init__(self, key: _Optional[str] = ..., value: _Optional[float] = ...) -> None: ...
    REQUEST_ID_FIELD_NUMBER: _ClassVar[int]
    TASK_FIELD_NUMBER: _ClassVar[int]
    REASONING_FIELD_NUMBER: _ClassVar[int]
    RULE_SET_FIELD_NUMBER: _ClassVar[int]
    GRIPPER_FIELD_NUMBER: _ClassVar[int]
    SEED_FIELD_NUMBER: _ClassVar[int]
    FRAME_ID_FIELD_NUMBER: _ClassVar[int]
    FOUND_FIELD_NUMBER: _ClassVar[int]
    REASON_FIELD_NUMBER: _ClassVar[int]
    REGION_FIELD_NUMBER: _ClassVar[int]
    ALTERNATIVES_FIELD_NUMBER: _ClassVar[int]
    PRIMITIVES_FIELD_NUMBER: _ClassVar[int]
    GRASPS_FIELD_NUMBER: _ClassVar[int]
    EXPLANATION_FIELD_NUMBER: _ClassVar[int]
    SCENE_FIELD_NUMBER: _ClassVar[int]
    TIMINGS_MS_FIELD_NUMBER: _ClassVar[int]
    POINTS_FIELD_NUMBER: _ClassVar[int]
    REJECTED_FIELD_NUMBER: _ClassVar[int]
    REHEARSAL_FIELD_NUMBER: _ClassVar[int]
    request_id: str
    task: str
    reasoning: Reasoning
    rule_set: RuleSet
    gripper: str
    seed: int
    frame_id: str
    found: bool
    reason: Reason
    region: Region
    alternatives: _containers.RepeatedCompositeFieldContainer[Region]
    primitives: _containers.RepeatedCompositeFieldContainer[Primitive]
    grasps: _containers.RepeatedCompositeFieldContainer[Grasp]
    explanation: Explanation
    scene: Scene
    timings_ms: _containers.ScalarMap[str, float]
    points: PointLabels
    rejected: _containers.RepeatedCompositeFieldContainer[RejectedGrasp]
    rehearsal: Rehearsal
    def __init__(self, request_id: _Optional[str] = ..., task: _Optional[str] = ..., reasoning: _Optional[_Union[Reasoning, str]] = ..., rule_set: _Optional[_Union[RuleSet, str]] = ..., gripper: _Optional[str] = ..., seed: _Optional[int] = ..., frame_id: _Optional[str] = ..., found: _Optional[bool] = ..., reason: _Optional[_Union[Reason, _Mapping]] = ..., region: _Optional[_Union[Region, _Mapping]] = ..., alternatives: _Optional[_Iterable[_Union[Region, _Mapping]]] = ..., primitives: _Optional[_Iterable[_Union[Primitive, _Mapping]]] = ..., grasps: _Optional[_Iterable[_Union[Grasp, _Mapping]]] = ..., explanation: _Optional[_Union[Explanation, _Mapping]] = ..., scene: _Optional[_Union[Scene, _Mapping]] = ..., timings_ms: _Optional[_Mapping[str, float]] = ..., points: _Optional[_Union[PointLabels, _Mapping]] = ..., rejected: _Optional[_Iterable[_Union[RejectedGrasp, _Mapping]]] = ..., rehearsal: _Optional[_Union[Rehearsal, _Mapping]] = ...) -> None: ...

class RequestName(_message.Message):
    __slots__ = ("request_id",)
    REQUEST_ID_FIELD_NUMBER: _ClassVar[int]
    request_id: str
    def __init__(self, request_id: _Optional[str] = ...) -> None: ...

class KeptExplanation(_message.Message):
    __slots__ = ("request_id", "task", "reasoning", "rule_set", "found", "reason", "region", "alternatives", "explanation")
    REQUEST_ID_FIELD_NUMBER: _ClassVar[int]
    TASK_FIELD_NUMBER: _ClassVar[int]
    REASONING_FIELD_NUMBER: _ClassVar[int]
    RULE_SET_FIELD_NUMBER: _ClassVar[int]
    FOUND_FIELD_NUMBER: _ClassVar[int]
    REASON_FIELD_NUMBER: _ClassVar[int]
    REGION_FIELD_NUMBER: _ClassVar[int]
    ALTERNATIVES_FIELD_NUMBER: _ClassVar[int]
    EXPLANATION_FIELD_NUMBER: _ClassVar[int]
    request_id: str
    task: str
    reasoning: Reasoning
    rule_set: RuleSet
    found: bool
    reason: Reason
    region: Region
    alternatives: _containers.RepeatedCompositeFieldContainer[Region]
    explanation: Explanation
    def __init__(self, request_id: _Optional[str] = ..., task: _Optional[str] = ..., reasoning: _Optional[_Union[Reasoning, str]] = ..., rule_set: _Optional[_Union[RuleSet, str]] = ..., found: _Optional[bool] = ..., reason: _Optional[_Union[Reason, _Mapping]] = ..., region: _Optional[_Union[Region, _Mapping]] = ..., alternatives: _Optional[_Iterable[_Union[Region, _Mapping]]] = ..., explanation: _Optional[_Union[Explanation, _Mapping]] = ...) -> None: ...

class TaskDefinition(_message.Message):
    __slots__ = ("name", "description", "requires", "grasp", "avoids")
    NAME_FIELD_NUMBER: _ClassVar[int]
    DESCRIPTION_FIELD_NUMBER: _ClassVar[int]
    REQUIRES_FIELD_NUMBER: _ClassVar[int]
    GRASP_FIELD_NUMBER: _ClassVar[int]
    AVOIDS_FIELD_NUMBER: _ClassVar[int]
    name: str
    description: str
    requires: _containers.RepeatedScalarFieldContainer[str]
    grasp: _containers.RepeatedScalarFieldContainer[str]
    avoids: _containers.RepeatedScalarFieldContainer[str]
    def __init__(self, name: _Optional[str] = ..., description: _Optional[str] = ..., requires: _Optional[_Iterable[str]] = ..., grasp: _Optional[_Iterable[str]] = ..., avoids: _Optional[_Iterable[str]] = ...) -> None: ...

class Task(_message.Message):
    __slots__ = ("name", "description", "requires", "grasp", "avoids", "reasoning", "builtin")
    NAME_FIELD_NUMBER: _ClassVar[int]
    DESCRIPTION_FIELD_NUMBER: _ClassVar[int]
    REQUIRES_FIELD_NUMBER: _ClassVar[int]
    GRASP_FIELD_NUMBER: _ClassVar[int]
    AVOIDS_FIELD_NUMBER: _ClassVar[int]
    REASONING_FIELD_NUMBER: _ClassVar[int]
    BUILTIN_FIELD_NUMBER: _ClassVar[int]
    name: str
    description: str
    requires: _containers.RepeatedScalarFieldContainer[str]
    grasp: _containers.RepeatedScalarFieldContainer[str]
    avoids: _containers.RepeatedScalarFieldContainer[str]
    reasoning: _containers.RepeatedScalarFieldContainer[Reasoning]
    builtin: bool
    def __init__(self, name: _Optional[str] = ..., description: _Optional[str] = ..., requires: _Optional[_Iterable[str]] = ..., grasp: _Optional[_Iterable[str]] = ..., avoids: _Optional[_Iterable[str]] = ..., reasoning: _Optional[_Iterable[_Union[Reasoning, str]]] = ..., builtin: _Optional[bool] = ...) -> None: ...

class TaskList(_message.Message):
    __slots__ = ("tasks",)
    TASKS_FIELD_NUMBER: _ClassVar[int]
    tasks: _containers.RepeatedCompositeFieldContainer[Task]
    def __init__(self, tasks: _Optional[_Iterable[_Union[Task, _Mapping]]] = ...) -> None: ...

class TaskName(_message.Message):
    __slots__ = ("name",)
    NAME_FIELD_NUMBER: _ClassVar[int]
    name: str
    def __init__(self, name: _Optional[str] = ...) -> None: ...

class Affordance(_message.Message):
    __slots__ = ("name", "description")
    NAME_FIELD_NUMBER: _ClassVar[int]
    DESCRIPTION_FIELD_NUMBER: _ClassVar[int]
    name: str
    description: str
    def __init__(self, name: _Optional[str] = ..., description: _Optional[str] = ...) -> None: ...

class AffordanceList(_message.Message):
    __slots__ = ("affordances",)
    AFFORDANCES_FIELD_NUMBER: _ClassVar[int]
    affordances: _containers.RepeatedCompositeFieldContainer[Affordance]
    def __init__(self, affordances: _Optional[_Iterable[_Union[Affordance, _Mapping]]] = ...) -> None: ...

class Link(_message.Message):
    __slots__ = ("name", "xyz", "rpy")
    NAME_FIELD_NUMBER: _ClassVar[int]
    XYZ_FIELD_NUMBER: _ClassVar[int]
    RPY_FIELD_NUMBER: _ClassVar[int]
    name: str
    xyz: Vector3
    rpy: Vector3
    def __init__(self, name: _Optional[str] = ..., xyz: _Optional[_Union[Vector3, _Mapping]] = ..., rpy: _Optional[_Union[Vector3, _Mapping]] = ...) -> None: ...

class Stroke(_message.Message):
    __slots__ = ("opening", "positions", "advance")
    OPENING_FIELD_NUMBER: _ClassVar[int]
    POSITIONS_FIELD_NUMBER: _ClassVar[int]
    ADVANCE_FIELD_NUMBER: _ClassVar[int]
    opening: float
    positions: _containers.RepeatedScalarFieldContainer[float]
    advance: float
    def __init__(self, opening: _Optional[float] = ..., positions: _Optional[_Iterable[float]] = ..., advance: _Optional[float] = ...) -> None: ...

class Urdf(_message.Message):
    __slots__ = ("links", "joints", "strokes")
    LINKS_FIELD_NUMBER: _ClassVar[int]
    JOINTS_FIELD_NUMBER: _ClassVar[int]
    STROKES_FIELD_NUMBER: _ClassVar[int]
    links: _containers.RepeatedCompositeFieldContainer[Link]
    joints: _containers.RepeatedScalarFieldContainer[str]
    strokes: _containers.RepeatedCompositeFieldContainer[Stroke]
    def __init__(self, links: _Optional[_Iterable[_Union[Link, _Mapping]]] = ..., joints: _Optional[_Iterable[str]] = ..., strokes: _Optional[_Iterable[_Union[Stroke, _Mapping]]] = ...) -> None: ...

class ParallelGripper(_message.Message):
    __slots__ = ("name", "description", "max_opening", "finger_width", "finger_thickness", "finger_length", "tip_beyond_tcp", "palm_size", "force", "urdf")
    NAME_FIELD_NUMBER: _ClassVar[int]
    DESCRIPTION_FIELD_NUMBER: _ClassVar[int]
    MAX_OPENING_FIELD_NUMBER: _ClassVar[int]
    FINGER_WIDTH_FIELD_NUMBER: _ClassVar[int]
    FINGER_THICKNESS_FIELD_NUMBER: _ClassVar[int]
    FINGER_LENGTH_FIELD_NUMBER: _ClassVar[int]
    TIP_BEYOND_TCP_FIELD_NUMBER: _ClassVar[int]
    PALM_SIZE_FIELD_NUMBER: _ClassVar[int]
    FORCE_FIELD_NUMBER: _ClassVar[int]
    URDF_FIELD_NUMBER: _ClassVar[int]
    name: str
    description: str
    max_opening: float
    finger_width: float
    finger_thickness: float
    finger_length: float
    tip_beyond_tcp: float
    palm_size: Vector3
    force: float
    urdf: Urdf
    def __init__(self, name: _Optional[str] = ..., description: _Optional[str] = ..., max_opening: _Optional[float] = ..., finger_width: _Optional[float] = ..., finger_thickness: _Optional[float] = ..., finger_length: _Optional[float] = ..., tip_beyond_tcp: _Optional[float] = ..., palm_size: _Optional[_Union[Vector3, _Mapping]] = ..., force: _Optional[float] = ..., urdf: _Optional[_Union[Urdf, _Mapping]] = ...) -> None: ...

class SuctionGripper(_message.Message):
    __slots__ = ("name", "description", "cup_diameter", "cup_length", "compliance", "palm_size", "force", "urdf")
    NAME_FIELD_NUMBER: _ClassVar[int]
    DESCRIPTION_FIELD_NUMBER: _ClassVar[int]
    CUP_DIAMETER_FIELD_NUMBER: _ClassVar[int]
    CUP_LENGTH_FIELD_NUMBER: _ClassVar[int]
    COMPLIANCE_FIELD_NUMBER: _ClassVar[int]
    PALM_SIZE_FIELD_NUMBER: _ClassVar[int]
    FORCE_FIELD_NUMBER: _ClassVar[int]
    URDF_FIELD_NUMBER: _ClassVar[int]
    name: str
    description: str
    cup_diameter: float
    cup_length: float
    compliance: float
    palm_size: Vector3
    force: float
    urdf: Urdf
    def __init__(self, name: _Optional[str] = ..., description: _Optional[str] = ..., cup_diameter: _Optional[float] = ..., cup_length: _Optional[float] = ..., compliance: _Optional[float] = ..., palm_size: _Optional[_Union[Vector3, _Mapping]] = ..., force: _Optional[float] = ..., urdf: _Optional[_Union[Urdf, _Mapping]] = ...) -> None: ...

class Gripper(_message.Message):
    __slots__ = ("parallel", "suction")
    PARALLEL_FIELD_NUMBER: _ClassVar[int]
    SUCTION_FIELD_NUMBER: _ClassVar[int]
    parallel: ParallelGripper
    suction: SuctionGripper
    def __init__(self, parallel: _Optional[_Union[ParallelGripper, _Mapping]] = ..., suction: _Optional[_Union[SuctionGripper, _Mapping]] = ...) -> None: ...

class GripperList(_message.Message):
    __slots__ = ("grippers",)
    GRIPPERS_FIELD_NUMBER: _ClassVar[int]
    grippers: _containers.RepeatedCompositeFieldContainer[Gripper]
    def __init__(self, grippers: _Optional[_Iterable[_Union[Gripper, _Mapping]]] = ...) -> None: ...

class Superquadric(_message.Message):
    __slots__ = ("parameters",)
    PARAMETERS_FIELD_NUMBER: _ClassVar[int]
    parameters: _containers.RepeatedScalarFieldContainer[float]
    def __init__(self, parameters: _Optional[_Iterable[float]] = ...) -> None: ...

class Faces(_message.Message):
    __slots__ = ("indices",)
    INDICES_FIELD_NUMBER: _ClassVar[int]
    indices: _containers.RepeatedScalarFieldContainer[int]
    def __init__(self, indices: _Optional[_Iterable[int]] = ...) -> None: ...

class ExecuteRequest(_message.Message):
    __slots__ = ("pose", "width", "primitives", "vertices", "faces", "object_pose", "mass", "plane", "up", "gripper", "actor", "strict", "seed", "animate", "motion", "highlight", "heading", "points", "viewpoint", "believed", "brisk")
    POSE_FIELD_NUMBER: _ClassVar[int]
    WIDTH_FIELD_NUMBER: _ClassVar[int]
    PRIMITIVES_FIELD_NUMBER: _ClassVar[int]
    VERTICES_FIELD_NUMBER: _ClassVar[int]
    FACES_FIELD_NUMBER: _ClassVar[int]
    OBJECT_POSE_FIELD_NUMBER: _ClassVar[int]
    MASS_FIELD_NUMBER: _ClassVar[int]
    PLANE_FIELD_NUMBER: _ClassVar[int]
    UP_FIELD_NUMBER: _ClassVar[int]
    GRIPPER_FIELD_NUMBER: _ClassVar[int]
    ACTOR_FIELD_NUMBER: _ClassVar[int]
    STRICT_FIELD_NUMBER: _ClassVar[int]
    SEED_FIELD_NUMBER: _ClassVar[int]
    ANIMATE_FIELD_NUMBER: _ClassVar[int]
    MOTION_FIELD_NUMBER: _ClassVar[int]
    HIGHLIGHT_FIELD_NUMBER: _ClassVar[int]
    HEADING_FIELD_NUMBER: _ClassVar[int]
    POINTS_FIELD_NUMBER: _ClassVar[int]
    VIEWPOINT_FIELD_NUMBER: _ClassVar[int]
    BELIEVED_FIELD_NUMBER: _ClassVar[int]
    BRISK_FIELD_NUMBER: _ClassVar[int]
    pose: Pose
    width: float
    primitives: _containers.RepeatedCompositeFieldContainer[Superquadric]
    vertices: PointCloud
    faces: Faces
    object_pose: Pose
    mass: float
    plane: SupportPlane
    up: Vector3
    gripper: str
    actor: Actor
    strict: bool
    seed: int
    animate: bool
    motion: bool
    highlight: _containers.RepeatedScalarFieldContainer[bool]
    heading: Vector3
    points: PointCloud
    viewpoint: Vector3
    believed: Believed
    brisk: bool
    def __init__(self, pose: _Optional[_Union[Pose, _Mapping]] = ..., width: _Optional[float] = ..., primitives: _Optional[_Iterable[_Union[Superquadric, _Mapping]]] = ..., vertices: _Optional[_Union[PointCloud, _Mapping]] = ..., faces: _Optional[_Union[Faces, _Mapping]] = ..., object_pose: _Optional[_Union[Pose, _Mapping]] = ..., mass: _Optional[float] = ..., plane: _Optional[_Union[SupportPlane, _Mapping]] = ..., up: _Optional[_Union[Vector3, _Mapping]] = ..., gripper: _Optional[str] = ..., actor: _Optional[_Union[Actor, str]] = ..., strict: _Optional[bool] = ..., seed: _Optional[int] = ..., animate: _Optional[bool] = ..., motion: _Optional[bool] = ..., highlight: _Optional[_Iterable[bool]] = ..., heading: _Optional[_Union[Vector3, _Mapping]] = ..., points: _Optional[_Union[PointCloud, _Mapping]] = ..., viewpoint: _Optional[_Union[Vector3, _Mapping]] = ..., believed: _Optional[_Union[Believed, str]] = ..., brisk: _Optional[bool] = ...) -> None: ...

class Phase(_message.Message):
    __slots__ = ("name", "simulated_s")
    NAME_FIELD_NUMBER: _ClassVar[int]
    SIMULATED_S_FIELD_NUMBER: _ClassVar[int]
    name: str
    simulated_s: float
    def __init__(self, name: _Optional[str] = ..., simulated_s: _Optional[float] = ...) -> None: ...

class ExecuteResponse(_message.Message):
    __slots__ = ("success", "lifted", "outcome", "message", "lift_height", "phases", "animation", "motion_times", "motion_object", "motion_hand", "motion_opening", "motion_phases", "motion_joints", "motion_base")
    SUCCESS_FIELD_NUMBER: _ClassVar[int]
    LIFTED_FIELD_NUMBER: _ClassVar[int]
    OUTCOME_FIELD_NUMBER: _ClassVar[int]
    MESSAGE_FIELD_NUMBER: _ClassVar[int]
    LIFT_HEIGHT_FIELD_NUMBER: _ClassVar[int]
    PHASES_FIELD_NUMBER: _ClassVar[int]
    ANIMATION_FIELD_NUMBER: _ClassVar[int]
    MOTION_TIMES_FIELD_NUMBER: _ClassVar[int]
    MOTION_OBJECT_FIELD_NUMBER: _ClassVar[int]
    MOTION_HAND_FIELD_NUMBER: _ClassVar[int]
    MOTION_OPENING_FIELD_NUMBER: _ClassVar[int]
    MOTION_PHASES_FIELD_NUMBER: _ClassVar[int]
    MOTION_JOINTS_FIELD_NUMBER: _ClassVar[int]
    MOTION_BASE_FIELD_NUMBER: _ClassVar[int]
    success: bool
    lifted: bool
    outcome: Outcome
    message: str
    lift_height: float
    phases: _containers.RepeatedCompositeFieldContainer[Phase]
    animation: bytes
    motion_times: _containers.RepeatedScalarFieldContainer[float]
    motion_object: _containers.RepeatedScalarFieldContainer[float]
    motion_hand: _containers.RepeatedScalarFieldContainer[float]
    motion_opening: _containers.RepeatedScalarFieldContainer[float]
    motion_phases: _containers.RepeatedScalarFieldContainer[str]
    motion_joints: _containers.RepeatedScalarFieldContainer[float]
    motion_base: _containers.RepeatedScalarFieldContainer[float]
    def __init__(self, success: _Optional[bool] = ..., lifted: _Optional[bool] = ..., outcome: _Optional[_Union[Outcome, str]] = ..., message: _Optional[str] = ..., lift_height: _Optional[float] = ..., phases: _Optional[_Iterable[_Union[Phase, _Mapping]]] = ..., animation: _Optional[bytes] = ..., motion_times: _Optional[_Iterable[float]] = ..., motion_object: _Optional[_Iterable[float]] = ..., motion_hand: _Optional[_Iterable[float]] = ..., motion_opening: _Optional[_Iterable[float]] = ..., motion_phases: _Optional[_Iterable[str]] = ..., motion_joints: _Optional[_Iterable[float]] = ..., motion_base: _Optional[_Iterable[float]] = ...) -> None: ...

class Error(_message.Message):
    __slots__ = ("code", "message", "details", "request_id")
    CODE_FIELD_NUMBER: _ClassVar[int]
    MESSAGE_FIELD_NUMBER: _ClassVar[int]
    DETAILS_FIELD_NUMBER: _ClassVar[int]
    REQUEST_ID_FIELD_NUMBER: _ClassVar[int]
    code: str
    message: str
    details: _struct_pb2.Struct
    request_id: str
    def __init__(self, code: _Optional[str] = ..., message: _Optional[str] = ..., details: _Optional[_Union[_struct_pb2.Struct, _Mapping]] = ..., request_id: _Optional[str] = ...) -> None: ...
