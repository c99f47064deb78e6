#!/usr/bin/python3
"""The node is killed at random moments: nothing that it acknowledged is lost, and nothing is torn."""

import os
import random
import shutil
import sqlite3
import sys
import tempfile
import threading
import time
import unittest
import xml.etree.ElementTree

import rospy
import rostest
import yaml
from calibration_client import PACKAGE, CalibrationClient, CalibrationNode, values_of, wait_for
from emulated_streams import EmulatedStreams

KILLS = 100
FURTHER_KILLS = 100  # at most, where lives were too short for a call to be confirmed: on a busy computer
SEED = 20240611
LONGEST_LIFE = 0.5  # [s] of one node after it is up
LONGEST_FURTHER_LIFE = 5.0  # [s]
CAPTURE_DURATION = 0.1  # [s]
FIRST_POSES = 6  # enough for the joint cycle
# The two services that put parameters in force again, and what else a user may call meanwhile.
ACTIONS = ("calibrate_joint", "calibrate_joint", "save", "save", "restore", "reset", "remove_sample")


def in_one_thread(function):
    thread = threading.Thread(target=function, daemon=True)
    thread.start()
    return thread


class Acknowledged:
    """What the node has confirmed. Of the call that was cut off nothing is known: it may have worked."""

    def __init__(self):
        self.samples = {}
        self.removed = set()
        self.in_removal = set()  # asked for, not confirmed
        self.revision = 0
        self.parameters = {}  # of revisions, as published
        self.files = {}  # content of saved files by name
        self.counts = {}  # confirmed calls by service

    def count(self, service):
        self.counts[service] = self.counts.get(service, 0) + 1


class Kill(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.directory = os.path.join(self.folder.name, "calibration")
        self.random = random.Random(SEED)
        self.client = CalibrationClient()
        self.streams = EmulatedStreams()
        self.addCleanup(self.streams.stop)
        # A page takes longer than a life.
        self.node = CalibrationNode(self.directory, report_page=False)
        self.addCleanup(self.node.stop)
        self.known = Acknowledged()
        self.wrong_answers = []

    def test_nothing_acknowledged_is_lost(self):
        self.client.start(self.node)
        self.remember_parameters()
        for _ in range(FIRST_POSES):
            self.move()
            wait_for(self.capture, "a sample")
        for kill in range(KILLS + FURTHER_KILLS):
            if kill >= KILLS and not self.unconfirmed():
                break
            with self.subTest(kill=kill):
                self.work_until_killed(LONGEST_LIFE if kill < KILLS else LONGEST_FURTHER_LIFE)
                self.check_database()
                self.check_files()
                self.client.start(self.node)
                self.check_state()
        self.check_revisions()
        print("acknowledged before kills:", self.known.counts)
        self.assertEqual(self.unconfirmed(), set())

    def unconfirmed(self):
        """Services of which no call was confirmed yet."""
        return (set(ACTIONS) | {"capture"}) - set(self.known.counts)

    # -- life of one node ----------------------------------------------------------------------------

    def work_until_killed(self, longest_life):
        self.move()
        life = self.random.uniform(0.0, longest_life)
        workers = [in_one_thread(self.keep_capturing), in_one_thread(self.keep_calling)]
        # The moment of the kill is what is random here, nothing waits for it.
        time.sleep(life)
        self.node.kill()
        for worker in workers:
            worker.join()
        self.assertEqual(self.wrong_answers, [])

    def move(self):
        self.streams.move_to([self.random.uniform(-0.4, 0.4) for _ in range(3)])

    def capture(self):
        answer = self.client.call("capture", duration=CAPTURE_DURATION)
        if answer.success:
            self.known.samples[answer.sample.id] = answer.sample
            self.known.count("capture")
        return answer.success

    def keep_capturing(self):
        self.until_the_node_is_gone(self.capture)

    def keep_calling(self):
        self.until_the_node_is_gone(lambda: self.call(self.random.choice(ACTIONS)))

    def until_the_node_is_gone(self, action):
        try:
            while True:
                action()
        except rospy.ServiceException:
            # The connection ends a moment before the process can be seen to.
            wait_for(lambda: not self.node.alive(), "the end of the node that does not answer")
        except AssertionError as error:
            self.wrong_answers.append(str(error))

    def call(self, service):
        fields = {}
        if service == "restore":
            fields["revision"] = self.random.choice(sorted(self.known.parameters))
        if service == "remove_sample":
            if len(self.known.samples) <= FIRST_POSES:
                return
            fields["id"] = self.random.choice(sorted(self.known.samples))
            self.known.in_removal.add(fields["id"])
        answer = self.client.call(service, **fields)
        if answer.success:
            self.confirm(service, fields, answer)
        elif service in ("restore", "reset"):
            raise AssertionError(f"{service}: {answer.message}")

    def confirm(self, service, fields, answer):
        self.known.count(service)
        if service == "remove_sample":
            self.known.samples.pop(fields["id"])
            self.known.removed.add(fields["id"])
        elif service == "save":
            self.known.files.update(self.saved_files())
        else:
            self.known.revision += 1
            if service == "restore":
                parameters = self.known.parameters[fields["revision"]]
                self.known.parameters[self.known.revision] = parameters

    # -- what is left --------------------------------------------------------------------------------

    def check_database(self):
        """On a copy, so that the node does its own recovery afterwards."""
        with tempfile.TemporaryDirectory() as copy:
            for name in os.listdir(self.directory):
                if name.startswith("session.db"):
                    shutil.copy(os.path.join(self.directory, name), copy)
            database = sqlite3.connect(os.path.join(copy, "session.db"))
            self.assertEqual(database.execute("PRAGMA integrity_check").fetchall(), [("ok",)])
            self.assertEqual(database.execute("PRAGMA foreign_key_check").fetchall(), [])
            database.close()

    def saved_files(self):
        files = {}
        for name in sorted(os.listdir(self.directory)):
            if name.endswith((".yaml", ".urdf")):
                with open(os.path.join(self.directory, name), encoding="utf-8") as file:
                    files[name] = file.read()
        return files

    def check_files(self):
        """Every file under a final name is whole, and those that were there did not change."""
        files = self.saved_files()
        for name, content in self.known.files.items():
            self.assertEqual(files.get(name), content, name)
        for name in set(files) - set(self.known.files):
            if name.endswith(".urdf"):
                xml.etree.ElementTree.fromstring(files[name])
                continue
            actuator = yaml.safe_load(files[name])["actuator"]
            self.assertEqual(len(actuator["coils"]), 24, name)
        self.known.files = files

    def check_state(self):
        self.check_samples()
        self.check_parameters()

    def check_samples(self):
        held = self.client.held()
        for number, sample in self.known.samples.items():
            if number not in self.known.in_removal or number in held:
                self.assertEqual(held.get(number), sample, f"sample {number}")
        for number in self.known.removed:
            self.assertNotIn(number, held)
        new = set(held) - set(self.known.samples)
        self.assertLessEqual(len(new), 1, "only the capture that was cut off is not known")
        self.assertTrue(all(number > max(self.known.samples) for number in new))
        self.known.samples = held
        self.known.in_removal.clear()

    def check_parameters(self):
        revision = self.client.revision()
        self.assertEqual(self.client.latest("status").revision, revision)
        # At most the call that was cut off is not known.
        self.assertIn(revision, (self.known.revision, self.known.revision + 1))
        if revision == self.known.revision and revision in self.known.parameters:
            found = values_of(self.client.latest("parameters"))
            self.assertEqual(found, self.known.parameters[revision])
        self.known.revision = revision
        self.remember_parameters()

    def remember_parameters(self):
        parameters = self.client.latest("parameters")
        self.known.parameters[parameters.revision] = values_of(parameters)

    def check_revisions(self):
        """Every revision that is known can be brought back, to the last bit."""
        for number, values in sorted(self.known.parameters.items()):
            answer = self.client.call("restore", revision=number)
            self.assertTrue(answer.success, answer.message)
            self.known.revision += 1
            wait_for(lambda: self.client.revision() == self.known.revision, "the restored parameters")
            self.assertEqual(values_of(self.client.latest("parameters")), values, number)


if __name__ == "__main__":
    rospy.init_node("calibration_kill")
    rostest.rosrun(PACKAGE, "calibration_kill", Kill, sys.argv)
