"""Writes the MCAP fixtures with the format's own library; messages of ROS by mcap-ros2-support and, where that cannot, by rosbags.

    pip install mcap mcap-ros2-support mcap-protobuf-support rosbags && python make_mcap.py
"""

import json
from pathlib import Path

import numpy as np
from google.protobuf.descriptor_pb2 import FileDescriptorProto
from google.protobuf.descriptor_pool import DescriptorPool
from google.protobuf.message_factory import GetMessageClass
from google.protobuf.timestamp_pb2 import DESCRIPTOR as TIMESTAMP
from mcap.writer import CompressionType, Writer
from mcap_protobuf.schema import build_file_descriptor_set
from mcap_ros2.writer import Writer as Ros2Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

HERE = Path(__file__).parent / "fixtures" / "mcap"
FIRST = 1_700_000_000_123_456_789
STEP = 1_000_001
LINE = "=" * 80 + "\n"

HEADER = "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
TIME = "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
JOINT_STATE = (
    "std_msgs/Header header\n\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n"
    + LINE + HEADER + LINE + TIME
)
ALL = (
    "# All types that there are\nuint8 LIMIT=7\nstring GREETING=\"a # b\"\n"
    "bool flag\nbyte octet\nchar letter\nint8 i8\nuint8 u8\nint16 i16\nuint16 u16\nint32 i32\nuint32 u32\n"
    "int64 i64\nuint64 u64\nfloat32 f32\nfloat64 f64 1.5\nstring text\nstring<=9 short\n"
    "int16[3] three\nfloat64[] any\nuint8[<=4] few\nstring[] words\ntest_msgs/Point[2] points\nPoint[] path\n"
    "uint8[] image\nbuiltin_interfaces/Duration took\nfloat32 last\n"
    + LINE + "MSG: test_msgs/Point\nfloat32 x\nfloat64 y\n"
    + LINE + "MSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec\n"
)


def stamp(k: int) -> dict:
    return {"sec": (FIRST + STEP * k) // 10**9, "nanosec": (FIRST + STEP * k) % 10**9}


def joint_state(k: int) -> dict:
    """From the third message on the joints come in another order, and one more of them."""
    names = ["elbow", "wrist"] if k < 2 else ["wrist", "grip", "elbow"]
    angle = {"elbow": 0.25 * k, "wrist": -0.5 * k, "grip": 7.0}
    return {
        "header": {"stamp": stamp(k), "frame_id": "base"},
        "name": names,
        "position": [angle[name] for name in names],
        "velocity": [2 * angle[name] for name in names],
        "effort": [],
    }


def everything(k: int) -> dict:
    return {
        "flag": k % 2 == 1, "octet": k, "letter": 65, "i8": -k, "u8": k, "i16": -300 * k, "u16": 300 * k,
        "i32": -70000 * k, "u32": 70000 * k, "i64": -5_000_000_000 * k, "u64": 5_000_000_000 * k,
        "f32": 0.5 * k, "f64": 0.125 * k, "text": "x" * (k % 5), "short": "é",
        "three": [k, k + 1, k + 2], "any": [1.0 * i for i in range(k % 3)], "few": [k, 2 * k],
        "words": ["a"] * (k % 3),
        "points": [{"x": 1.0 * k, "y": 2.0 * k}, {"x": 3.0 * k, "y": 4.0 * k}],
        "path": [{"x": 5.0, "y": 6.0}],
        "image": list(range(256)) * 2, "took": {"sec": -1, "nanosec": 500_000_000}, "last": 1.5 * k,
    }


def ros2(name: str, compression: CompressionType, messages: int) -> None:
    with open(HERE / name, "wb") as out:
        writer = Ros2Writer(out, chunk_size=2048, compression=compression)
        joints = writer.register_msgdef("sensor_msgs/msg/JointState", JOINT_STATE)
        types = writer.register_msgdef("test_msgs/msg/All", ALL)
        for k in range(messages):
            at = {"log_time": FIRST + STEP * k, "publish_time": FIRST, "sequence": k}
            writer.write_message("/joint_states", joints, joint_state(k), **at)
            if k % 2 == 0:
                writer.write_message("/all", types, everything(k), **at)
        writer.finish()


def plain(name: str, **options: object) -> tuple:
    out = open(HERE / name, "wb")
    writer = Writer(out, **options)
    writer.start()
    return out, writer


def texts() -> None:
    """JSON, without chunks and without a summary's index of them, and what cannot be decoded."""
    out, writer = plain("json.mcap", use_chunking=False)
    schema = writer.register_schema("Motor", "jsonschema", b'{"type":"object"}')
    motor = writer.register_channel("motor", "json", schema)
    bare = writer.register_channel("bare", "json", 0)
    idl = writer.register_schema("a/msg/B", "ros2idl", b"module a { };")
    unknown = writer.register_channel("idl", "cdr", idl)
    writer.add_attachment(FIRST, FIRST, "notes.txt", "text/plain", b"nothing of interest")
    for k in range(20):
        message = {
            "stamp": {"sec": (FIRST + STEP * k) // 10**9, "nsec": (FIRST + STEP * k) % 10**9},
            "on": k % 2 == 0,
            "name": "left",
            "current": None if k < 3 else 0.25 * k,
            "joint": {"angle": 2 * k, "raw": [k, -k]},
        }
        writer.add_message(motor, FIRST + STEP * k, json.dumps(message).encode(), FIRST, k)
        writer.add_message(bare, FIRST + STEP * k, json.dumps(0.5 * k).encode(), FIRST, k)
        writer.add_message(unknown, FIRST + STEP * k, b"\0\1\0\0", FIRST, k)
    writer.finish()
    out.close()


def other_encodings(name: str, **options: object) -> None:
    """Big-endian messages of ROS 2, and those of ROS 1, both of rosbags; protobuf by Google's library."""
    out, writer = plain(name, **options)
    modern = get_typestore(Stores.ROS2_HUMBLE)
    modern.register(get_types_from_msg(ALL, "test_msgs/msg/All"))
    schema = writer.register_schema("test_msgs/msg/All", "ros2msg", ALL.encode())
    big = writer.register_channel("/big", "cdr", schema)
    old = get_typestore(Stores.ROS1_NOETIC)
    definition, _ = old.generate_msgdef("sensor_msgs/msg/JointState", ros_version=1)
    schema = writer.register_schema("sensor_msgs/JointState", "ros1msg", definition.encode())
    ros1 = writer.register_channel("/ros1", "ros1", schema)
    motor = protobuf()
    descriptors = build_file_descriptor_set(motor).SerializeToString()
    schema = writer.register_schema("test.Motor", "protobuf", descriptors)
    proto = writer.register_channel("/proto", "protobuf", schema)
    for k in range(12):
        time = FIRST + STEP * k
        values = everything(k)
        message = modern_message(modern, values)
        data = modern.serialize_cdr(message, "test_msgs/msg/All", little_endian=False)
        writer.add_message(big, time, bytes(data), time, k)
        state = joint_state(k)
        kinds = old.types
        message = kinds["sensor_msgs/msg/JointState"](
            header=kinds["std_msgs/msg/Header"](
                seq=k,
                stamp=kinds["builtin_interfaces/msg/Time"](**state["header"]["stamp"]),
                frame_id="base",
            ),
            name=state["name"],
            position=np.array(state["position"]),
            velocity=np.array(state["velocity"]),
            effort=np.array([]),
        )
        data = old.serialize_ros1(message, "sensor_msgs/msg/JointState")
        writer.add_message(ros1, time, bytes(data), time, k)
        message = motor(angle=0.5 * k, counts=k, raw=[k, 2 * k], enabled=k % 2 == 0, label="m")
        message.stamp.seconds, message.stamp.nanos = time // 10**9, time % 10**9
        if k % 2:
            message.inner.current = 0.25 * k
        writer.add_message(proto, time, message.SerializeToString(), time, k)
    writer.finish()
    out.close()


def modern_message(store: object, values: dict) -> object:
    kinds = store.types
    point = kinds["test_msgs/msg/Point"]
    values = dict(values)
    for name, kind in [("three", np.int16), ("any", np.float64), ("few", np.uint8), ("image", np.uint8)]:
        values[name] = np.array(values[name], kind)
    values["points"] = [point(**p) for p in values["points"]]
    values["path"] = [point(**p) for p in values["path"]]
    values["took"] = kinds["builtin_interfaces/msg/Duration"](**values["took"])
    return kinds["test_msgs/msg/All"](**values)


def protobuf() -> type:
    file = FileDescriptorProto(name="motor.proto", package="test", syntax="proto3")
    file.dependency.append("google/protobuf/timestamp.proto")
    inner = file.message_type.add(name="Inner")
    inner.field.add(name="current", number=1, type="TYPE_DOUBLE", label="LABEL_OPTIONAL")
    motor = file.message_type.add(name="Motor")
    fields = [
        ("stamp", "TYPE_MESSAGE", "LABEL_OPTIONAL", ".google.protobuf.Timestamp"),
        ("angle", "TYPE_DOUBLE", "LABEL_OPTIONAL", None),
        ("counts", "TYPE_SINT64", "LABEL_OPTIONAL", None),
        ("raw", "TYPE_INT32", "LABEL_REPEATED", None),
        ("enabled", "TYPE_BOOL", "LABEL_OPTIONAL", None),
        ("label", "TYPE_STRING", "LABEL_OPTIONAL", None),
        ("inner", "TYPE_MESSAGE", "LABEL_OPTIONAL", ".test.Inner"),
    ]
    for number, (name, kind, label, of) in enumerate(fields, 1):
        motor.field.add(name=name, number=number, type=kind, label=label, type_name=of)
    pool = DescriptorPool()
    pool.AddSerializedFile(TIMESTAMP.serialized_pb)
    pool.Add(file) if hasattr(pool, "Add") else pool.AddSerializedFile(file.SerializeToString())
    return GetMessageClass(pool.FindMessageTypeByName("test.Motor"))


HERE.mkdir(parents=True, exist_ok=True)
ros2("ros2_zstd.mcap", CompressionType.ZSTD, 40)
ros2("ros2_lz4.mcap", CompressionType.LZ4, 10)
ros2("ros2_none.mcap", CompressionType.NONE, 10)
texts()
other_encodings("encodings.mcap", chunk_size=1024, compression=CompressionType.LZ4)
other_encodings("encodings_plain.mcap", use_chunking=False)
