"""How a program that moves the rotor ends: with ROS still there to take the currents to zero."""

import signal
import sys
import time

import rosgraph
import rospy

POLL = 0.2  # [s] between looks for a master
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
    currents to zero; after ten seconds it raises again."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, _raise)


def registered(name, **options):
    """Registers a program that ends by exception with the master, and waits for one. False, and a sentence, where it is
    told to end before that is done. Options: of rospy.init_node."""
    end_by_exception()
    try:
        _wait_for_master(name)
        rospy.init_node(name, disable_signals=True, **options)
    except KeyboardInterrupt:
        pass
    # What asks the master catches all exceptions now and then.
    if _told[0] is not None:
        print(f"{name}: interrupted before it began.", flush=True)
    return _told[0] is None


def _wait_for_master(name):
    is_said = False
    while _told[0] is None and not rosgraph.is_master_online():
        if not is_said and _told[0] is None:
            print(f"{name}: no ROS master answers at {rosgraph.get_master_uri()}; waiting for one.", file=sys.stderr, flush=True)
        is_said = True
        time.sleep(POLL)
    if _told[0] is not None:
        raise KeyboardInterrupt
