"""Parameters of a description file in force, in the place of the calibration node."""

import contextlib
import os
import subprocess

import rospy
from spherical_actuator_calibration.msg import ActuatorParameters
from spherical_actuator_calibration.programs import program

PATIENCE = 30.0  # [s] for the node, on however busy a computer
PERIOD = 0.05  # [s] between two looks


@contextlib.contextmanager
def parameters_in_force(ns, path):
    """The node publish_parameters with a description, as long as the context lasts, which gives their message. Raises
    RuntimeError when the parameters do not come; the node has told why."""
    stator = rospy.get_param(f"{ns}/orientation_controller/frames/stator", "stator")
    name = f"publish_parameters_{os.getpid()}"
    by_caller = {}
    subscriber = rospy.Subscriber(
        f"{ns}/parameters",
        ActuatorParameters,
        lambda message: by_caller.update({message._connection_header["callerid"]: message}),
    )
    arguments = [f"__ns:={ns}", f"__name:={name}", f"_description:={path}", f"_frame:={stator}"]
    # In a session of its own: Ctrl-C is for us, who end it when the rotor rests.
    node = subprocess.Popen([program("publish_parameters"), *arguments], start_new_session=True)
    try:
        end = rospy.get_time() + PATIENCE
        while f"{ns}/{name}" not in by_caller:
            if node.poll() is not None or rospy.get_time() > end:
                raise RuntimeError(f"The parameters of {path} do not come.")
            rospy.sleep(PERIOD)
        yield by_caller[f"{ns}/{name}"]
    finally:
        subscriber.unregister()
        node.terminate()
        node.wait()


def wait_for_control_by(ns, parameters):
    """Until the orientation controller controls by the parameters of a message: what comes within a motion waits for its
    end. Raises RuntimeError when it does not."""
    told = []
    subscriber = rospy.Subscriber(f"{ns}/orientation_controller/parameters_in_force", ActuatorParameters, told.append)
    try:
        end = rospy.get_time() + PATIENCE
        while not told or told[-1].header.stamp != parameters.header.stamp:
            if rospy.get_time() > end:
                raise RuntimeError(
                    f"{ns}/orientation_controller does not control by the parameters: start it, or wait for the end of "
                    "its motion, then run this again."
                )
            rospy.sleep(PERIOD)
    finally:
        subscriber.unregister()
