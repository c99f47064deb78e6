"""A second master of ROS beside that of the test."""

import os
import subprocess

import rosgraph
import rospy
import yaml
from calibration_client import NODE, wait_for


class SecondMaster:
    """The program, started and ended by the test."""

    def __init__(self, uri):
        self._uri = uri
        self._process = subprocess.Popen(
            ["rosmaster", "--core", "-p", uri.rsplit(":", 1)[1]],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def wait_until_up(self, parameters):
        """Until it answers, and knows these parameters of the first one."""
        proxy = rosgraph.Master("/calibration_bad_day", master_uri=self._uri)
        wait_for(proxy.is_online, "the second master")
        for name in parameters:
            proxy.setParam(name, rospy.get_param(name))

    def stop(self):
        self._process.terminate()
        self._process.wait()

    def samples_held(self):
        """Identifiers of the samples in use by the calibration node below it, asked for by the command line."""

        def listed():
            answer = subprocess.run(
                ["rosservice", "call", f"{NODE}/list_samples"],
                env={**os.environ, "ROS_MASTER_URI": self._uri},
                capture_output=True,
                text=True,
                check=False,
            )
            return answer.stdout if answer.returncode == 0 else None

        samples = yaml.safe_load(wait_for(listed, "the node below the second master"))["samples"]
        return [sample["id"] for sample in samples]
