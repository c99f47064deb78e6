#!/usr/bin/python3
"""The node at the full rates of the laboratory: no message is lost, and the services answer.

Prints what it measures: processor time, and times from request to result.
"""

import os
import sys
import tempfile
import time
import unittest

import rosbag
import rospy
import rostest
from calibration_client import (
    NAMESPACE,
    PACKAGE,
    STREAMS,
    CalibrationClient,
    CalibrationNode,
    play,
    run_tool,
    wait_for,
)

SESSION = {
    "joint-poses": 6,
    "main-coil-poses": 6,
    "coil-poses": 0,
    "validation-poses": 0,
    "joint-rate": 1000,
    "tracker-rate": 240,
    "wrench-rate": 1000,
    "current-rate": 1000,
}
SAMPLES_FOR_A_CYCLE = 4
PAUSE = 0.1  # [s] between calls: as many as people make, so that the streams make the load


class FullRates(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.bag = os.path.join(self.folder.name, "session.bag")
        self.counts = self.record()
        self.client = CalibrationClient()
        directory = os.path.join(self.folder.name, "calibration")
        self.node = CalibrationNode(directory, auto_capture=True, diagnostic_period=0.1)
        self.addCleanup(self.node.stop)
        self.client.start(self.node)

    def record(self):
        """Records a session, and counts its messages by stream."""
        description = os.path.join(rospy.get_param("~config"), "pm_spherical_8x24.yaml")
        run_tool("simulate_recording", actuator=description, output=self.bag, **SESSION)
        with rosbag.Bag(self.bag) as bag:
            topics = bag.get_type_and_topic_info().topics
        return {stream: topics[f"{NAMESPACE}/{stream}"].message_count for stream in STREAMS}

    def test_no_message_is_lost_while_services_answer(self):
        player = play(self.bag)
        self.addCleanup(player.wait)
        wait_for(self.accepted_of_joints, "the first measurements")
        begin = time.monotonic()
        cpu_before = self.node.cpu_seconds()
        latencies = self.use_services(player)
        elapsed = time.monotonic() - begin
        cpu = (self.node.cpu_seconds() - cpu_before) / elapsed
        self.assertEqual(player.wait(), 0)
        for stream, sent in self.counts.items():
            self.check_received(stream, sent)
        self.report(cpu, latencies)

    def accepted_of_joints(self):
        return int(self.client.diagnostic("joint_states").get("accepted", 0))

    def use_services(self, player):
        """Calls services for as long as the recording plays; returns seconds by what was waited for."""
        latencies = {"list_samples": [], "sample to parameters": [], "solve": []}
        while player.poll() is None:
            begin = time.monotonic()
            held = self.client.call("list_samples").samples
            latencies["list_samples"].append(time.monotonic() - begin)
            if len(held) >= SAMPLES_FOR_A_CYCLE:
                self.calibrate_after_next_sample(player, latencies)
            time.sleep(PAUSE)
        self.assertGreater(len(latencies["sample to parameters"]), 0)
        return latencies

    def calibrate_after_next_sample(self, player, latencies):
        before = len(self.client.samples)
        while len(self.client.samples) == before:
            if player.poll() is not None:
                return
            time.sleep(0.0005)
        begin = time.monotonic()
        revision = self.client.revision()
        answer = self.client.call("calibrate_joint")
        self.assertTrue(answer.success, answer.message)
        wait_for(lambda: self.client.revision() > revision, "the parameters")
        latencies["sample to parameters"].append(time.monotonic() - begin)
        latencies["solve"].append(answer.report.solve_time)

    def check_received(self, stream, sent):
        def counts():
            values = self.client.diagnostic(stream)
            return int(values["accepted"]), int(values["refused"])

        try:
            wait_for(lambda: sum(counts()) >= sent, "all messages")
        finally:
            self.assertEqual(counts(), (sent, 0), stream)

    def report(self, cpu, latencies):
        print(f"MEASURED processor time of the node: {100.0 * cpu:.1f} % of one core")
        for what, times in latencies.items():
            times.sort()
            median, largest = times[len(times) // 2], times[-1]
            print(
                f"MEASURED {what}: median {1e3 * median:.1f} ms, "
                f"largest {1e3 * largest:.1f} ms, of {len(times)}"
            )


if __name__ == "__main__":
    rospy.init_node("calibration_full_rates")
    rostest.rosrun(PACKAGE, "calibration_full_rates", FullRates, sys.argv)
