"""Parameters of a description file in force, in the place of the calibration node."""

import contextlib
import os
import subprocess

import rospy
from spherical_actuator_calibration.msg import ActuatorParameters
from spherical_actuator_calibration.programs import program

PATIENCE = 30.0  # [s] for the node, on however busy a computer
PERIOD = 0.05  # [s] between two looks
# For the controller to hear them, too, which it does not confirm [s]: what comes within a motion waits for its end.
OTHERS = 1.0


@contextlib.contextmanager
def parameters_in_force(ns, path):
    """The node publish_parameters with a description, as long as the context lasts. Raises RuntimeError when the
    parameters do not come; the node has told why."""
    stator = rospy.get_param(f"{ns}/orientation_controller/frames/stator", "stator")
    name = f"publish_parameters_{os.getpid()}"
    callers = set()
    subscriber = rospy.Subscriber(
        f"{ns}/parameters", ActuatorParameters, lambda message: callers.add(message._connection_header["callerid"])
    )
    arguments = [f"__ns:={ns}", f"__name:={name}", f"_description:={path}", f"_frame:={stator}"]
    # In a session of its own: Ctrl-C is for us, who end it when the rotor rests.
    node = subprocess.Popen([program("publish_parameters"), *arguments], start_new_session=True)
    try:
        end = rospy.get_time() + PATIENCE
        while f"{ns}/{name}" not in callers:
            if node.poll() is not None or rospy.get_time() > end:
                raise RuntimeError(f"The parameters of {path} do not come.")
            rospy.sleep(PERIOD)
        rospy.sleep(OTHERS)
        yield
    finally:
        subscriber.unregister()
        node.terminate()
        node.wait()
