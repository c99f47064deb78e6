#!/usr/bin/python3
"""The node at the full rates of the laboratory: no message is lost, and the services answer.

A computer that is busy with something else gets less: the rates that it can give.

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
    Reception,
    play,
    run_tool,
    stop_player,
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
RATES = (1.0, 0.5, 0.25)  # shares of the full rates, from the first until the node has the processor time for it
PAUSE = 0.1  # [s] between calls: as many as people make, so that the streams make the load


class FullRates(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.bag = os.path.join(self.folder.name, "session.bag")
        self.counts = self.record()
        self.client = CalibrationClient()

    def record(self):
        """Records a session, and counts its messages by stream."""
        description = os.path.join(rospy.get_param("~config"), "pm_spherical_8x24.yaml")
        run_tool("simulate_recording", actuator=description, output=self.bag, **SESSION)
        with rosbag.Bag(self.bag) as bag:
            topics = bag.get_type_and_topic_info().topics
        return {stream: topics[f"{NAMESPACE}/{stream}"].message_count for stream in STREAMS}

    def test_no_message_is_lost_while_services_answer(self):
        for rate in RATES:
            if self.takes_all_at(rate):
                return
        self.fail("the node never had the processor time for it, or no sample came before the recording was over")

    def takes_all_at(self, rate):
        """Plays to a new node, which must take every message; unless others had the processors, then false. Likewise
        where this program had so little of them that it ran no cycle meanwhile."""
        directory = os.path.join(self.folder.name, f"calibration_at_{rate}")
        node = CalibrationNode(directory, auto_capture=True, diagnostic_period=0.1)
        self.addCleanup(node.stop)
        self.client.start(node)
        self.reception = Reception(self.client, self.counts)
        player = play(self.bag, "--rate", str(rate))
        self.addCleanup(stop_player, player)
        wait_for(lambda: sum(self.client.received("joint_states")), "the first measurements")
        begin, cpu_before = time.monotonic(), node.cpu_seconds()
        latencies = self.use_services()
        cpu = (node.cpu_seconds() - cpu_before) / (time.monotonic() - begin)
        was_starved = node.was_starved()
        stop_player(player)
        node.stop()
        self.report(rate, cpu, latencies)
        received = {stream: self.client.received(stream) for stream in STREAMS}
        all_taken = {stream: (sent, 0) for stream, sent in self.counts.items()}
        if received != all_taken and was_starved:
            return False
        self.assertEqual(received, all_taken)
        return len(latencies["sample to parameters"]) > 0

    def use_services(self):
        """Calls services until every message was received; returns seconds by what was waited for."""
        latencies = {"list_samples": [], "sample to parameters": [], "solve": []}
        while self.reception.is_going_on():
            begin = time.monotonic()
            held = self.client.call("list_samples").samples
            latencies["list_samples"].append(time.monotonic() - begin)
            if len(held) >= SAMPLES_FOR_A_CYCLE:
                self.calibrate_after_next_sample(latencies)
            time.sleep(PAUSE)
        return latencies

    def calibrate_after_next_sample(self, latencies):
        before = len(self.client.samples)
        while len(self.client.samples) == before:
            if not self.reception.is_going_on():
                return
            time.sleep(0.001)
        begin = time.monotonic()
        revision = self.client.revision()
        answer = self.client.call("calibrate_joint")
        self.assertTrue(answer.success, answer.message)
        wait_for(lambda: self.client.revision() > revision, "the parameters")
        latencies["sample to parameters"].append(time.monotonic() - begin)
        latencies["solve"].append(answer.report.solve_time)

    @staticmethod
    def report(rate, cpu, latencies):
        print(f"MEASURED processor time of the node at {rate} of the full rates: {100.0 * cpu:.1f} % of one core")
        for what, times in latencies.items():
            if not times:
                continue
            times.sort()
            median, largest = times[len(times) // 2], times[-1]
            print(
                f"MEASURED {what}: median {1e3 * median:.1f} ms, "
                f"largest {1e3 * largest:.1f} ms, of {len(times)}"
            )


if __name__ == "__main__":
    rospy.init_node("calibration_full_rates")
    rostest.rosrun(PACKAGE, "calibration_full_rates", FullRates, sys.argv)
