#!/usr/bin/python3
"""Commands a current in coil 3, as a node of its own: commander.py <current [A]> <rate [Hz], 0: as fast as it can>."""

import sys

import rospy
from calibration_client import NAMESPACE
from spherical_actuator_calibration.msg import CoilCurrents
from spherical_actuator_calibration.wall_stamp import wall_stamp

COILS = 24


def main():
    current, rate = map(float, sys.argv[1:3])
    rospy.init_node("second_commander", anonymous=True)
    publisher = rospy.Publisher(f"{NAMESPACE}/coil_command", CoilCurrents, queue_size=1, tcp_nodelay=True)
    message = CoilCurrents(current=[0.0] * COILS)
    message.current[2] = current
    while not rospy.is_shutdown():
        message.header.stamp = wall_stamp()
        publisher.publish(message)
        if rate > 0.0:
            rospy.rostime.wallsleep(1.0 / rate)


if __name__ == "__main__":
    main()
