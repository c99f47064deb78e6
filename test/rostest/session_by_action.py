#!/usr/bin/python3
"""A whole calibration by the action session alone, as a laboratory's own program has it: session_by_action.py"""

import sys

import actionlib
import rospy
from spherical_actuator_calibration.msg import SessionAction, SessionGoal, SessionResult


def tell(feedback):
    done = feedback.progress
    print(f"{done.stage}: pose {done.pose} of {done.poses}, {done.captures} of {done.captures_wanted} captures")


def main():
    rospy.init_node("calibrate_unit")
    session = actionlib.SimpleActionClient("/actuator/calibration/session", SessionAction)
    session.wait_for_server()
    session.send_goal(SessionGoal(poses=8, drive_fixture=True, dwell=0.2, settling=0.15), feedback_cb=tell)
    session.wait_for_result()
    print(session.get_result().message)
    return session.get_result().outcome != SessionResult.COMPLETE


if __name__ == "__main__":
    sys.exit(main())
