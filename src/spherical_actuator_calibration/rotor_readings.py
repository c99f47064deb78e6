"""Where the rotor is, for programs that wait for it or drive by it: what its joint sensors read; of a rotor without
joints what the tracker measures, as the turns about x, then y, then z of the stator that samples and plans have in the
place of joint angles."""

import math

import rospy
from geometry_msgs.msg import Quaternion, QuaternionStamped
from sensor_msgs.msg import JointState

from .unit_quaternion import normalised

FRESH = 1.0  # [s]; longer than the pauses of a sensor on a busy computer
TURNS = ("rotation_x", "rotation_y", "rotation_z")  # as the core names them


def turns_of(x, y, z, w):
    """(q1, q2, q3) [rad] of a unit quaternion, rotor to stator: about x, then y, then z; q2 within a quarter turn, the
    others within half a turn. Where q2 is a quarter turn, only the sum or difference of the others is determined."""
    r12, r22 = 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)  # of the rotation matrix, counted from 0
    first = math.atan2(-r12, r22)
    second = math.atan2(2.0 * (x * z + w * y), math.hypot(r12, r22))
    # What is left after the first turn was taken back.
    sine, cosine = math.sin(first), math.cos(first)
    row_1 = (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z))
    row_2 = (2.0 * (x * z - w * y), 2.0 * (y * z + w * x))
    return first, second, math.atan2(*(cosine * one + sine * two for one, two in zip(row_1, row_2)))


def quaternion_of_turns(turns):
    """(x, y, z, w) of turns [rad], the inverse of turns_of."""
    (sx, cx), (sy, cy), (sz, cz) = ((math.sin(0.5 * turn), math.cos(0.5 * turn)) for turn in turns)
    return (
        sx * cy * cz + cx * sy * sz,
        cx * sy * cz - sx * cy * sz,
        cx * cy * sz + sx * sy * cz,
        cx * cy * cz - sx * sy * sz,
    )


class _Readings:
    """The newest reading."""

    def __init__(self, topic, kind):
        self._newest = None  # reading, time: one tuple, so that readers in other threads never see half of it
        self._subscribe = lambda: rospy.Subscriber(topic, kind, self.keep)
        self._subscriber = None

    def listen(self):
        """From now on they come. Returns itself."""
        self._subscriber = self._subscriber or self._subscribe()
        return self

    def close(self):
        """No more come, and none is fresh."""
        subscriber, self._subscriber = self._subscriber, None
        if subscriber:
            subscriber.unregister()
        self._newest = None

    def keep(self, message):
        """Of a message that tells one."""
        raise NotImplementedError

    def _take(self, reading):
        self._newest = (reading, rospy.get_time())

    def fresh(self):
        """Of the three joints, or turns [rad]; None where none came for FRESH."""
        newest = self._newest
        if newest is None or rospy.get_time() - newest[1] > FRESH:
            return None
        return newest[0]


class JointReadings(_Readings):
    """The angles of an actuator's joints, in the order of its description."""

    quantity = "joint angles"
    device = "joint sensor"
    fixture = "fixture/target"  # topic of a fixture that turns the rotor to a reading
    target_type = JointState

    def __init__(self, ns, names):
        self.names = list(names)
        super().__init__(f"{ns}/joint_states", JointState)

    def keep(self, message):
        """Of a message without all of the joints nothing is kept."""
        by_name = dict(zip(message.name, message.position))
        if all(name in by_name for name in self.names):
            self._take(tuple(by_name[name] for name in self.names))

    def target(self, reading):
        """Message for the fixture."""
        return JointState(name=self.names, position=list(reading))


class OrientationReadings(_Readings):
    """The orientation of a rotor without joints, as turns."""

    quantity = "orientations"
    device = "tracker"
    fixture = "fixture/orientation_target"
    target_type = QuaternionStamped

    def __init__(self, ns, frame):
        self.names = list(TURNS)
        self._frame = frame
        super().__init__(f"{ns}/measured_orientation", QuaternionStamped)

    def keep(self, message):
        """What is no unit quaternion is not kept."""
        q = message.quaternion
        unit, _ = normalised((q.x, q.y, q.z, q.w))
        if unit is not None:
            self._take(turns_of(*unit))

    def target(self, reading):
        """Message for the fixture, in the frame of the stator."""
        message = QuaternionStamped(quaternion=Quaternion(*quaternion_of_turns(reading)))
        message.header.stamp = rospy.Time.now()
        message.header.frame_id = self._frame
        return message


def readings_of(ns, actuator):
    """Readings of an actuator by its description (the parameter `actuator`), which are yet to listen."""
    joints = actuator["joints"]
    if joints:
        return JointReadings(ns, [joint["name"] for joint in joints])
    return OrientationReadings(ns, rospy.get_param(f"{ns}/calibration/frames/stator", "stator"))
