"""The pose that the rotor is to come to, for those who show it."""

import rospy
from sensor_msgs.msg import JointState


class WantedPose:
    """Publishes it on wanted_pose as soon as it has shown one, whenever it changes; without names where there is none."""

    def __init__(self, ns, names):
        self._names = names
        self._shown = None
        self._publisher = rospy.Publisher(ns + "/wanted_pose", JointState, queue_size=1, latch=True)

    def show(self, pose):
        """A Pose; None: none."""
        if pose == self._shown:
            return
        self._shown = pose
        message = JointState()
        message.header.stamp = rospy.Time.now()
        if pose is not None:
            message.name, message.position = self._names, list(pose.joints)
        self._publisher.publish(message)
