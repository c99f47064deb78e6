"""How a program that moves the rotor ends: with ROS still there to take the currents to zero."""

import signal
import time

PATIENCE = 10.0  # [s] in which a program that was told to end is left to do so

_told = [None]  # when, the first time


def _raise(_number, _frame):
    now = time.monotonic()
    if _told[0] is None:
        _told[0] = now
    elif now < _told[0] + PATIENCE:
        return
    raise KeyboardInterrupt


def end_by_exception():
    """Makes SIGINT, SIGTERM and SIGHUP raise KeyboardInterrupt in the main thread, also where a shell in the
    background has them ignored. Once: what an impatient hand sends next does not keep the program from taking the
    currents to zero; after ten seconds it raises again. For programs that call rospy.init_node(disable_signals=True)."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, _raise)
