"""What the joint sensors read, for programs that wait for it or drive by it."""

import rospy
from sensor_msgs.msg import JointState

FRESH = 1.0  # [s]; longer than the pauses of a sensor on a busy computer


class JointReadings:
    """The newest angles of an actuator's joints, in the order of its description."""

    def __init__(self, ns, names):
        self._names = list(names)
        self._newest = None  # angles, time: one tuple, so that readers in other threads never see half of it
        self._subscriber = rospy.Subscriber(f"{ns}/joint_states", JointState, self.keep)

    def keep(self, message):
        """Of a message without all of the joints nothing is kept."""
        by_name = dict(zip(message.name, message.position))
        if all(name in by_name for name in self._names):
            self._newest = (tuple(by_name[name] for name in self._names), rospy.get_time())

    def fresh(self):
        """Joint angles [rad]; None where none came for FRESH."""
        newest = self._newest
        if newest is None or rospy.get_time() - newest[1] > FRESH:
            return None
        return newest[0]
