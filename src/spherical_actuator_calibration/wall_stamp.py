"""Stamps of commands to devices, which are real and know no time but that of the wall clock."""

import time

import rospy

NANOSECONDS = 10**9


def wall_stamp():
    """Now by the wall clock, even where /use_sim_time is set."""
    return rospy.Time(*divmod(time.time_ns(), NANOSECONDS))
