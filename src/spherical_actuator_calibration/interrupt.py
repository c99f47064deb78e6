"""How a program that moves the rotor ends: with ROS still there to take the currents to zero."""

import signal


def _raise(_number, _frame):
    raise KeyboardInterrupt


def end_by_exception():
    """Makes SIGINT, SIGTERM and SIGHUP raise KeyboardInterrupt in the main thread, also where a shell in the
    background has them ignored. For programs that call rospy.init_node(disable_signals=True)."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, _raise)
