"""A motion that free_motion recorded, as a bag."""

import genpy
import laboratory
import rosbag
from geometry_msgs.msg import QuaternionStamped
from sensor_msgs.msg import JointState
from spherical_actuator_calibration.msg import CoilCurrents

STREAMS = {"joint_states": "joints", "coil_currents": "currents", "measured_orientation": "orientations"}


def write_bag(path, recording, coils):
    """As a laboratory records it; returns the number of messages by stream."""
    messages = []

    def add(topic, message, t):
        message.header.stamp = genpy.Time.from_sec(100.0 + t)
        messages.append((message.header.stamp, topic, message))

    for t, q in zip(*recording["joints"]):
        add("joint_states", JointState(name=["joint_1", "joint_2", "joint_3"], position=list(q)), t)
    for t, current in zip(*recording["currents"]):
        add("coil_currents", CoilCurrents(current=list(current)), t)
    for topic, key in (("coil_command", "commands"), ("coil_setpoints", "setpoints")):
        for t, current in zip(*recording.get(key, ((), ()))):
            add(topic, CoilCurrents(current=list(current)), t)
    for t, R in zip(*recording["orientations"]):
        message = QuaternionStamped()
        message.header.frame_id = "stator"
        q = message.quaternion
        q.x, q.y, q.z, q.w = laboratory.quaternion_xyzw(R)
        add("measured_orientation", message, t)
    assert len(recording["currents"][1][0]) == coils
    with rosbag.Bag(path, "w") as bag:
        for stamp, topic, message in sorted(messages, key=lambda one: one[0]):
            bag.write("/actuator/" + topic, message, stamp)
    return {stream: len(recording[key][0]) for stream, key in STREAMS.items()}
