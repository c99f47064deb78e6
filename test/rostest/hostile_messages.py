#!/usr/bin/python3
"""No message, request or connection ends a node, makes it large, or keeps it from answering: lengths that lie, bytes
that are missing, numbers and stamps at the ends of their ranges, text that a terminal would obey, floods."""

import collections
import contextlib
import re
import shutil
import sys
import tempfile
import threading
import time
import unittest

import hostile_peer
import rosgraph
import rospy
import rostest
from calibration_client import NAMESPACE, PACKAGE, wait_for
from driver_node import DriverNode
from hostile_kinds import CONNECTIONS, GOOD, MESSAGES, PUBLISHERS, REQUESTS, bytes_of, good
from hostile_peer import HostilePublisher, framed

LARGEST = 200.0  # [MB] of a node
FLOOD = 1.0  # [s]


class HostileMessages(unittest.TestCase):
    """The nodes of a laboratory, and somebody who talks to all of them."""

    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.mkdtemp()
        shipped = rospy.get_param("/shipped")
        # Nobody answers there: what is received is judged all the same.
        for driver in ("coil_driver", "joint_sensor"):
            shipped[driver]["link"].update(host="127.0.0.1", port=9)
        options = {"calibration": {"directory": cls.directory, "auto_capture": True}, "visualization": {}, **shipped}
        cls.said = {name: collections.deque() for name in options}
        cls.nodes = {}
        cls.addClassCleanup(cls.end)
        for name, parameters in options.items():
            cls.nodes[name] = DriverNode(name, parameters)
        for name, node in cls.nodes.items():
            threading.Thread(target=cls.said[name].extend, args=(node.process.stderr.buffer,), daemon=True).start()
        cls.slowest = 0.0
        cls.count = 0
        cls.expect_all_well("their start")

    @classmethod
    def end(cls):
        for node in cls.nodes.values():
            node.process.kill()
            node.process.wait()
        shutil.rmtree(cls.directory, ignore_errors=True)

    @classmethod
    def expect_all_well(cls, kind):
        """Every node lives, is no larger than it may be, and answers."""
        for name, node in cls.nodes.items():
            wait_for(lambda: cls.lives(name, kind) and cls.answers(name), f"an answer of {name}")  # noqa: B023
            size = hostile_peer.largest_memory(node.process.pid)
            if size > LARGEST:
                raise AssertionError(f"{name} has {size:.0f} MB after {kind}")
            cls.expect_printable(name)
        cls.count += 1

    @classmethod
    def expect_printable(cls, name):
        """Nothing that it said makes a terminal do anything, or is no text."""
        lines = cls.said[name]
        while lines:
            # The colours of the console are roscpp's own.
            line = re.sub(rb"\x1b\[(\d+)?m", b"", lines.popleft())
            if not line.decode(errors="replace").replace("\t", "").rstrip("\n").isprintable() or b"\xff" in line:
                raise AssertionError(f"{name} says {line}")

    @classmethod
    def lives(cls, name, kind):
        if cls.nodes[name].process.poll() is not None:
            raise AssertionError(f"{name} has ended after {kind}")
        return True

    @classmethod
    def answers(cls, name):
        begin = time.monotonic()
        try:
            hostile_peer.meet(f"{NAMESPACE}/{name}")
        except (OSError, EOFError, rosgraph.MasterException):
            return False
        cls.slowest = max(cls.slowest, time.monotonic() - begin)
        return True

    @staticmethod
    def name_of(topic):
        return topic if topic[0] == "/" else f"{NAMESPACE}/{topic}"

    def test_a_messages(self):
        publishers = {topic: HostilePublisher(self.name_of(topic), type(good(topic))) for topic in GOOD}
        for publisher in publishers.values():
            self.addCleanup(publisher.close)
            publisher.wait_for_visits(1)
        messages = 0
        for kind, (topics, make) in MESSAGES.items():
            for topic in topics:
                for content in make(topic):
                    publishers[topic].publish(content)
                    messages += 1
            self.expect_all_well(kind)
        for content in (bytes_of(good("coil_currents")), bytes_of(good("joint_states")) + bytes(60000)):
            for topic in ("coil_command", "joint_states", "measured_torque"):
                messages += hostile_peer.flood(publishers[topic], framed(content), FLOOD)
            self.expect_all_well(f"a flood of {len(content)} bytes each")
        print(f"{messages} messages")
        # All of them came: what was said last was judged last.
        refused = {"calibration": "joint_states", "coil_driver": "output", "tracker_bridge": "tracker/pose"}
        for node, task in refused.items():
            wait_for(lambda n=node, t=task: int(self.nodes[n].value(t, "refused")) >= 30, f"refusals of {node}")

    def test_b_publishers(self):
        for kind, welcome in PUBLISHERS.items():
            topics = ("joint_states", "coil_command", "parameters", "tracker/pose")
            # With its welcome from the first visit on.
            publishers = [HostilePublisher(self.name_of(topic), type(good(topic)), welcome) for topic in topics]
            for publisher in publishers:
                publisher.wait_for_visits(1)
            self.expect_all_well(kind)
            for publisher in publishers:
                publisher.close()

    def test_c_connections(self):
        for kind, content in CONNECTIONS.items():
            with contextlib.ExitStack() as links:
                for name in self.nodes:
                    link = links.enter_context(hostile_peer.connect(f"{NAMESPACE}/{name}"))
                    with contextlib.suppress(OSError):
                        link.sendall(content)
                self.expect_all_well(kind)
        with contextlib.ExitStack() as links:
            for name in self.nodes:
                for _ in range(100):
                    links.enter_context(hostile_peer.connect(f"{NAMESPACE}/{name}"))
            self.expect_all_well("a hundred connections at once")

    def test_d_requests(self):
        for kind, (service, content) in REQUESTS.items():
            with contextlib.suppress(EOFError):
                _, answer = hostile_peer.call(f"{NAMESPACE}/{service}", content)
                self.assertNotRegex(answer, rb"\x1b[\[\]]", kind)  # a stamp may have such a byte
            self.expect_all_well(kind)
        for name in self.nodes:
            # roscpp's own: one ends a node where rosconsole and log4cxx do not fit, the other keeps what it is given.
            for service in ("get_loggers", "set_logger_level"):
                with self.assertRaises(rosgraph.MasterException, msg=f"{name} offers {service}"):
                    hostile_peer.call(f"{NAMESPACE}/{name}/{service}", framed(b"a" * 1000000) + framed(b"info"))
        for length in (900000000, 0xFFFFFFFF):
            hostile_peer.call(f"{NAMESPACE}/calibration/restore", b"half", length)
            self.expect_all_well(f"a request of {length} bytes that ends at once")

    def test_e_what_is_left(self):
        """How large they became, and how slow."""
        for name, node in self.nodes.items():
            print(f"{name}: at most {hostile_peer.largest_memory(node.process.pid):.0f} MB")
        print(f"{self.count} kinds, slowest answer {self.slowest:.3f} s")
        self.assertGreaterEqual(self.count, 35)


if __name__ == "__main__":
    rospy.init_node("hostile_messages")
    rostest.rosrun(PACKAGE, "hostile_messages", HostileMessages, sys.argv)
