"""Kinds of messages, publishers, connections and requests that nobody sends on purpose to a node he wishes well."""

import io
import math
import struct
import time

import genpy
from geometry_msgs.msg import PoseStamped, QuaternionStamped, TransformStamped, Vector3Stamped, WrenchStamped
from hostile_peer import framed, header
from sensor_msgs.msg import JointState
from spherical_actuator_calibration.msg import (
    ActuatorParameters,
    CalibrationReport,
    CalibrationSample,
    CalibrationStatus,
    CoilCurrents,
    ParameterEstimate,
    PoleAxis,
    SampleResidual,
)
from tf2_msgs.msg import TFMessage

COILS = 24
LENGTHS = (0xFFFFFFFF, 0x7FFFFFFF, 0x10000000, 0x01000000)  # the last one: 16 million entries
LONGEST = 5 << 20  # [byte] of a message
LAST = genpy.Time(4294967295, 999999999)  # in the year 2106
INVALID = genpy.Time(5, 4294967295)  # more nanoseconds than a second has
ESCAPES = "\x1b[2J\x1b]0;owned\x07"
TRICK = "../../../../tmp/owned"
NAMES = ["joint_1", "joint_2", "joint_3"]


def bytes_of(message):
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def now():
    return genpy.Time.from_sec(time.time())


# What a good message of each topic is, without its stamp.
GOOD = {
    "joint_states": lambda: JointState(name=list(NAMES), position=[0.1, 0.2, 0.3]),
    "measured_orientation": QuaternionStamped,
    "measured_torque": Vector3Stamped,
    "coil_currents": lambda: CoilCurrents(current=[0.0] * COILS),
    "coil_command": lambda: CoilCurrents(current=[0.0] * COILS),
    "tracker/pose": PoseStamped,
    "ft_sensor/wrench": WrenchStamped,
    "orientation_target": QuaternionStamped,
    "joint_target": lambda: JointState(name=list(NAMES), position=[0.1, 0.2, 0.3]),
    "parameters": lambda: ActuatorParameters(actuator="pm_spherical_8x24", poles=[PoleAxis()]),
    "report": lambda: CalibrationReport(estimates=[ParameterEstimate()], residuals=[SampleResidual()]),
    "status": CalibrationStatus,
    "samples": lambda: CalibrationSample(current=[0.0] * COILS),
    "/tf": lambda: TFMessage(transforms=[transform()]),
    "/tf_static": lambda: TFMessage(transforms=[transform()]),
}
STAMPED = [topic for topic in GOOD if topic[0] != "/"]


def transform(parent="stator", child="tracker", w=1.0, stamp=None):
    result = TransformStamped()
    result.header.frame_id, result.child_frame_id = parent, child
    result.header.stamp = stamp or now()
    result.transform.rotation.w = w
    return result


def good(topic, stamp=None, frame=None):
    message = GOOD[topic]()
    if topic in STAMPED:
        message.header.stamp = stamp or now()
        if frame is not None:
            message.header.frame_id = frame
    return message


# -- kinds of messages: each gives the bytes of messages of a topic --------------------------------------------------


def lying_lengths(topic):
    content = bytes_of(good(topic))
    for place in range(0, min(len(content), 400) - 3, 4):
        for length in LENGTHS:
            yield content[:place] + struct.pack("<I", length) + content[place + 4 :]


def truncated(topic):
    content = bytes_of(good(topic))
    for size in {1, 4, 11, 16, len(content) // 2, len(content) - 1}:
        yield content[:size]


def empty(_topic):
    yield b""


def with_more(topic):
    yield bytes_of(good(topic)) + b"more" * 1000


def too_long(topic):
    yield bytes_of(good(topic)) + bytes(LONGEST)


def of_stamp(stamp):
    return lambda topic: [bytes_of(good(topic, stamp))]


def backwards(topic):
    for seconds in range(20):
        yield bytes_of(good(topic, genpy.Time(1700000000 - 1000 * seconds)))


def of_frame(frame):
    return lambda topic: [bytes_of(good(topic, frame=frame))]


def not_text(topic):
    content = bytes_of(good(topic, frame="@@@@"))
    yield content.replace(b"@@@@", b"\xff\xfe\x00\xc3")


def numbers(value):
    """Every number of a good message is this one."""

    def make(topic):
        content = bytes_of(good(topic, frame=FRAMES.get(topic, "stator")))
        number = struct.pack("<d", value)
        for eights in range(1, 5):
            if len(content) > 8 * eights:
                yield content[: -8 * eights] + number * eights

    return make


FRAMES = {"measured_torque": "rotor", "tracker/pose": "tracker", "ft_sensor/wrench": "ft_sensor"}


def quaternions(*components):
    def make(topic):
        message = good(topic, frame=FRAMES.get(topic, "stator"))
        target = message.pose.orientation if topic == "tracker/pose" else message.quaternion
        target.x, target.y, target.z, target.w = components
        yield bytes_of(message)

    return make


def joints(**fields):
    def make(_topic):
        message = JointState(name=list(NAMES), position=[0.1, 0.2, 0.3])
        message.header.stamp = now()
        for name, value in fields.items():
            setattr(message, name, value)
        yield bytes_of(message)

    return make


def currents(values):
    def make(_topic):
        message = CoilCurrents(current=values)
        message.header.stamp = now()
        yield bytes_of(message)

    return make


def transforms(*those):
    return lambda _topic: [bytes_of(TFMessage(transforms=list(those)))]


def poles(count, polar):
    def make(_topic):
        message = good("parameters")
        message.poles = [PoleAxis(polar=polar) for _ in range(count)]
        yield bytes_of(message)

    return make


ALL = list(GOOD)
FRAMED = ["measured_orientation", "measured_torque", "tracker/pose", "ft_sensor/wrench", "orientation_target"]
FRAMED += ["samples"]
TURNED = ["measured_orientation", "tracker/pose", "orientation_target"]
MEASURED = ["coil_currents", "coil_command"]
ANGLES = ["joint_states", "joint_target"]
TF = ["/tf", "/tf_static"]
MESSAGES = {
    "lying lengths": (ALL, lying_lengths),
    "truncated": (ALL, truncated),
    "empty": (ALL, empty),
    "more than the message": (ALL, with_more),
    "longer than any": (ALL, too_long),
    "year 2106": (STAMPED, of_stamp(LAST)),
    "year 0": (STAMPED, of_stamp(genpy.Time(0, 1))),
    "no stamp": (STAMPED, of_stamp(genpy.Time(0, 0))),
    "five seconds of nanoseconds": (STAMPED, of_stamp(INVALID)),
    "backwards": (STAMPED, backwards),
    "escapes in a frame": (STAMPED, of_frame(ESCAPES)),
    "a path for a frame": (STAMPED, of_frame(TRICK)),
    "a long frame": (STAMPED, of_frame("x" * 100000)),
    "frame that is no text": (FRAMED, not_text),
    "wrong frame": (FRAMED, of_frame("kitchen")),
    "NaN": (FRAMED + MEASURED + ANGLES, numbers(math.nan)),
    "infinity": (FRAMED + MEASURED + ANGLES, numbers(-math.inf)),
    "1e308": (FRAMED + MEASURED + ANGLES, numbers(1e308)),
    "5e-324": (FRAMED + MEASURED + ANGLES, numbers(5e-324)),
    "quaternion of zeros": (TURNED, quaternions(0.0, 0.0, 0.0, 0.0)),
    "quaternion of length 1000": (TURNED, quaternions(0.0, 0.0, 0.0, 1000.0)),
    "no names": (ANGLES, joints(name=[])),
    "no positions": (ANGLES, joints(position=[])),
    "names of others": (ANGLES, joints(name=["elbow", "wrist", "thumb"])),
    "one name three times": (ANGLES, joints(name=["joint_1"] * 3)),
    "escapes for names": (ANGLES, joints(name=[ESCAPES] * 3)),
    "many names": (ANGLES, joints(name=[""] * 100000)),
    "many positions": (ANGLES, joints(position=[0.0] * 100000)),
    "no currents": (MEASURED, currents([])),
    "many currents": (MEASURED, currents([0.0] * 100000)),
    "currents of 1e9 A": (MEASURED, currents([1e9] * COILS)),
    "escapes for frames": (TF, transforms(transform(ESCAPES, ESCAPES), transform("stator", ESCAPES))),
    "frame within itself": (TF, transforms(transform("tracker", "tracker"))),
    "frames in a circle": (TF, transforms(transform("marker", "rotor"), transform("rotor", "marker"))),
    "frames without names": (TF, transforms(transform("", ""))),
    "frames of 2106, NaN": (TF, transforms(transform(stamp=LAST), transform(w=math.nan), transform(w=0.0))),
    "many frames": (TF, transforms(*[transform("stator", f"frame_{n}") for n in range(10000)])),
    "no poles": (["parameters"], poles(0, 0.0)),
    "many poles": (["parameters"], poles(20000, 0.1)),
    "poles at NaN": (["parameters"], poles(8, math.nan)),
}


# -- kinds of publishers: each answers the header of a subscriber ----------------------------------------------------


def greeting(**changes):
    return lambda publisher, link: publisher.greet(link, **changes)


def sending(content):
    return lambda _publisher, link: link.sendall(content)


def closing(content):
    def welcome(_publisher, link):
        link.sendall(content)
        link.close()

    return welcome


def greeting_then(content, close=False):
    """A good header, and bytes that are no whole message."""

    def welcome(publisher, link):
        publisher.greet(link)
        link.sendall(content)
        if close:
            link.close()

    return welcome


PUBLISHERS = {
    "another md5": greeting(md5sum="0" * 32),
    "another type": greeting(type="std_msgs/String"),
    "escapes for a caller": greeting(callerid=ESCAPES),
    "a long header": greeting(message_definition="x" * 3000000),
    "a header of garbage": sending(framed(b"\xff" * 100)),
    "a header with a lying length": sending(struct.pack("<I", 900000000) + b"half"),
    "a header of lying fields": sending(framed(struct.pack("<I", 0x7FFFFFFF) + b"md5sum=*")),
    "an empty header": sending(framed(b"")),
    "no header at all": sending(b""),
    "closed before the header": closing(b""),
    "closed within the header": closing(b"\x50\x00\x00\x00type="),
    "closed within a message": greeting_then(b"\x50\x00\x00\x00half", close=True),
    "stops within a message": greeting_then(b"\x50\x00\x00\x00half"),
    "an endless message": greeting_then(struct.pack("<I", 900000000) + bytes(3 << 20)),
    "a message of 4 GB": greeting_then(struct.pack("<I", 0xFFFFFFFF) + b"half"),
}


# -- kinds of connections: what a node hears from who connects to it -------------------------------------------------


CONNECTIONS = {
    "a browser": b"GET / HTTP/1.1\r\nHost: robot\r\n\r\n",
    "garbage": bytes(range(256)) * 1000,
    "a lying length": struct.pack("<I", 900000000) + b"half",
    "a length of 4 GB": struct.pack("<I", 0xFFFFFFFF),
    "half a header": b"\x50\x00\x00\x00callerid=",
    "fields that lie": framed(struct.pack("<I", 0xFFFFFFF0) + b"topic=/x"),
    "many fields": framed(framed(b"a=b") * 200000),
    "neither topic nor service": header(callerid="/x"),
    "a topic that is none": header(callerid="/x", topic="/none", md5sum="*", type="*"),
    "a service that is none": header(callerid="/x", service="/none", md5sum="*"),
    "a path for a service": header(callerid="/x", service=TRICK, md5sum="*"),
    "escapes": header(callerid=ESCAPES, topic=ESCAPES, md5sum=ESCAPES, type=ESCAPES),
}


def text(value):
    return framed(value.encode())


# -- kinds of requests: service, and the bytes of its request --------------------------------------------------------


# Patterns, currents, time budget and purpose of a plan, as by default, and no poses before it.
REST_OF_PLAN = text("") + struct.pack("<ddd?I", 0.0, 0.0, 0.0, False, 0)

REQUESTS = {
    "half a request": ("calibration/capture", b"\0\0"),
    "an empty request": ("calibration/plan_poses", b""),
    "a request that goes on": ("calibration/restore", bytes(1000000)),
    "a text of lying length": ("calibration/plan_poses", struct.pack("<I", 0xFFFFFFFF)),
    "NaN of a duration": ("calibration/capture", struct.pack("<d?", math.nan, False)),
    "a duration of 1e308 s": ("calibration/capture", struct.pack("<d?", 1e308, False)),
    "a negative duration": ("calibration/capture", struct.pack("<d?", -1.0, True)),
    "revision 4294967295": ("calibration/restore", struct.pack("<I", 0xFFFFFFFF)),
    "sample 4294967295": ("calibration/remove_sample", struct.pack("<I", 0xFFFFFFFF)),
    "coil -2147483648": ("calibration/capture_planned", struct.pack("<3dIi2d?", *(0.0,) * 3, 1, -(2**31), 2.0, 0.1, False)),
    "a current of NaN": ("calibration/capture_planned", struct.pack("<3dIi2d?", *(0.0,) * 3, 1, 1, math.nan, 0.1, False)),
    "patterns of coil -2147483648": (
        "calibration/missing_patterns",
        struct.pack("<I3dIIi?", 1, *(0.0,) * 3, 1, 1, -(2**31), False),
    ),
    "poses of lying number": ("calibration/missing_patterns", struct.pack("<I", 0xFFFFFFFF)),
    "coil 4294967295": ("calibration/calibrate_coil", struct.pack("<I", 0xFFFFFFFF)),
    "no coil": ("calibration/calibrate_poles", struct.pack("<I", 0)),
    "a path for a cycle": ("calibration/plan_poses", text(TRICK) + struct.pack("<IId", 1, 1, 0.0) + REST_OF_PLAN),
    "escapes for a cycle": ("calibration/plan_poses", text(ESCAPES) + struct.pack("<IId", 1, 1, 0.0) + REST_OF_PLAN),
    "a cycle of a megabyte": (
        "calibration/plan_poses",
        text("x" * 1000000) + struct.pack("<IId", 1, 1, 0.0) + REST_OF_PLAN,
    ),
    "a plan without end": (
        "calibration/plan_poses",
        text("joint") + struct.pack("<IId", 0, 0xFFFFFFFF, math.nan) + REST_OF_PLAN,
    ),
    "coil 2147483647 of a pose before a plan": (
        "calibration/plan_poses",
        text("refine")
        + struct.pack("<IId", 0, 1, 0.0)
        + text("")
        + struct.pack("<ddd?I3dIIi?", 0.0, 0.0, 0.0, False, 1, *(0.0,) * 3, 1, 1, 2**31 - 1, False),
    ),
    "a path for patterns": (
        "calibration/plan_poses",
        text("refine") + struct.pack("<IId", 0, 1, 0.0) + text(TRICK) + struct.pack("<ddd?I", 0.0, 0.0, 0.0, False, 0),
    ),
    "NaN of currents and of a time": (
        "calibration/plan_poses",
        text("refine") + struct.pack("<IId", 0, 1, 0.0) + text("weighing") + struct.pack("<ddd?I", *[math.nan] * 3, False, 0),
    ),
}
