"""Launch files under test: what they would start, and a launch that runs."""

import os
import signal
import subprocess

import roslaunch
import rospy
from calibration_client import DEADLINE
from roslib.packages import find_node


def configuration_of(path, **arguments):
    """Nodes and parameters of a launch file. Raises when it is wrong, or lacks what it loads."""
    config = roslaunch.config.ROSLaunchConfig()
    options = [f"{name}:={value}" for name, value in arguments.items()]
    roslaunch.xmlloader.XmlLoader().load(path, config, argv=[path] + options, verbose=False)
    return config


def nodes_of(path, **arguments):
    return configuration_of(path, **arguments).nodes


def missing_programs(nodes):
    return [
        f"{node.package}/{node.type}" for node in nodes if not find_node(node.package, node.type)
    ]


class Launch:
    """A launch file on the master of the test."""

    def __init__(self, path, environment=None, **arguments):
        options = [f"{name}:={value}" for name, value in arguments.items()]
        self.process = subprocess.Popen(
            ["roslaunch", "--wait", path] + options,
            env={**os.environ, **(environment or {})},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def stop(self):
        """As Ctrl-C would, until every node has ended."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        self.process.wait(timeout=DEADLINE)


def launch_file(name):
    return os.path.join(rospy.get_param("~launch"), name)
