#!/usr/bin/python3
"""The coil driver node against an independent Modbus device. Every way to zero is tried."""

import contextlib
import math
import signal
import struct
import subprocess
import sys
import threading
import unittest

import hostile_peer
import rospy
import rostest
from calibration_client import NAMESPACE, PACKAGE, wait_for
from driver_node import ERROR, OK, DriverNode
from links import free_port
from modbus_device import Block, ModbusDevice, RudeServer, SerialPair, Setpoints
from spherical_actuator_calibration.msg import CoilCurrents
from spherical_actuator_calibration.wall_stamp import wall_stamp

UNIT = 2
COILS = 24
ENABLE = 100
HEARTBEAT = 101
TRIPPED = 100
MILLI = 1e-3
PATIENT = 1.0  # [s] of the watchdog where it must not be what makes zero, nor end a current on a busy computer
RESPONSE_TIMEOUT = 1.0  # [s] likewise; both are the longest that the driver allows
PATIENT_BEATS = 0.4  # [s] of the comparison of currents, where it is not what is tested: the most that is allowed


def amperes(word):
    return (word - 0x10000 if word & 0x8000 else word) * MILLI


class Commander:
    """Publishes one command again and again, as a controller does."""

    def __init__(self):
        self.publisher = rospy.Publisher(
            NAMESPACE + "/coil_command", CoilCurrents, queue_size=1, tcp_nodelay=True
        )
        self.command = None
        self.age = 0.0
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self):
        while not self._ended.wait(0.02):
            if self.command is not None:
                message = CoilCurrents(current=self.command)
                message.header.stamp = wall_stamp() - rospy.Duration(self.age)
                self.publisher.publish(message)

    def close(self):
        self._ended.set()
        self._thread.join()
        self.publisher.unregister()


class CoilDriver(unittest.TestCase):
    def setUp(self):
        self.measured = []
        measured = Block()
        self.device = ModbusDevice(UNIT, measured, Setpoints(measured, COILS))
        self.port = free_port()
        self.commander = Commander()
        subscriber = rospy.Subscriber(
            NAMESPACE + "/coil_currents", CoilCurrents, self.measured.append, queue_size=10000
        )
        self.addCleanup(self.device.stop)
        self.addCleanup(subscriber.unregister)
        self.addCleanup(self.commander.close)

    def start(self, response_timeout=RESPONSE_TIMEOUT, **changes):
        parameters = rospy.get_param("/shipped/coil_driver")
        parameters["diagnostic_period"] = 0.1
        parameters["link"].update(port=self.port, response_timeout=response_timeout)
        rate = changes.get("rate", parameters["rate"])
        parameters["deviation"]["beats"] = int(PATIENT_BEATS * rate)
        parameters.update(changes)
        node = DriverNode("coil_driver", parameters)
        self.addCleanup(node.close)
        return node

    def started(self, **changes):
        self.device.start_tcp(self.port)
        return self.start(**changes)

    @staticmethod
    def pattern(coil, current):
        command = [0.0] * COILS
        command[coil - 1] = current
        return command

    def setpoints(self):
        return [amperes(word) for word in self.device.holding_at(0, COILS)]

    def is_zero(self):
        return not any(self.device.holding_at(0, COILS))

    def follow(self, coil=3, current=1.5):
        self.commander.command = self.pattern(coil, current)
        wait_for(lambda: abs(self.setpoints()[coil - 1] - current) < MILLI, "the commanded current")

    def wait_for_zero(self):
        """Of the setpoints, and of the stages, which are switched off by a request of its own."""
        wait_for(self.is_zero, "zero currents")
        wait_for(lambda: self.device.holding_at(ENABLE) == [0], "stages that are off")

    def largest_written(self):
        """Largest current of one coil, and largest sum, that was ever written [A]."""
        blocks = [values for address, values in self.device.holding.history if address == 0]
        amounts = [[abs(amperes(word)) for word in block] for block in blocks]
        return max(map(max, amounts)), max(map(sum, amounts))

    # -- what it is for ------------------------------------------------------------------------------

    def test_follows_commands_and_publishes_what_is_measured(self):
        node = self.started(watchdog=PATIENT)
        self.follow(3, 1.5)
        self.device.holding.stick(3, 1490)
        wait_for(lambda: self.measured and abs(self.measured[-1].current[2] - 1.49) < 1e-9, "1.49 A")
        self.assertEqual(len(self.measured[-1].current), COILS)
        stamps = [message.header.stamp for message in self.measured]
        self.assertEqual(stamps, sorted(set(stamps)))
        told = [rospy.wait_for_message(NAMESPACE + "/coil_setpoints", CoilCurrents, PATIENT) for _ in range(2)]
        self.assertEqual([one.current[2] for one in told], [1.5, 1.5])
        self.assertLess(told[0].header.stamp, told[1].header.stamp)
        self.device.holding.are_applied = True
        self.follow(3, -0.7)
        wait_for(lambda: self.device.holding_at(ENABLE) == [1], "stages that are on")
        node.wait_for_level("output", OK)
        wait_for(lambda: node.message("output") == "commands are followed", "that it follows")

    def test_follows_commands_over_a_serial_line(self):
        pair = SerialPair()
        self.addCleanup(pair.close)
        self.device.start_serial(pair.device_end)
        link = {"type": "rtu", "device": pair.driver_end, "baud": 115200, "parity": "none"}
        link["response_timeout"] = RESPONSE_TIMEOUT
        node = self.start(link=link, rate=30.0, watchdog=PATIENT)
        self.follow(3, 1.5)
        node.end(signal.SIGTERM)
        self.assertTrue(self.is_zero())

    def test_never_goes_beyond_the_limits(self):
        node = self.started(watchdog=PATIENT)
        self.commander.command = [50.0] * COILS
        wait_for(lambda: sum(self.setpoints()) > 7.5, "the largest sum")
        wait_for(lambda: "limits/coil 2.5 A, limits/total 8 A" in node.message("output"), "that it clamps")
        self.commander.command = self.pattern(1, -9.0)
        wait_for(lambda: abs(self.setpoints()[0] + 2.5) < MILLI, "the largest current")
        coil, total = self.largest_written()
        self.assertLessEqual(coil, 2.5)
        self.assertLessEqual(total, 8.0 + COILS * 0.5 * MILLI)

    def test_changes_currents_no_faster_than_allowed(self):
        limits = {"coil": 2.5, "total": 8.0, "slew": 5.0}
        self.started(limits=limits, watchdog=PATIENT)
        self.follow(3, 2.0)
        blocks = [block for address, block in self.device.holding.history if address == 0]
        steps = [amperes(b[2]) - amperes(a[2]) for a, b in zip(blocks, blocks[1:])]
        # At most 50 ms count for one step, whatever the computer does meanwhile.
        self.assertLessEqual(max(steps), 5.0 * 0.05 + MILLI)
        self.assertGreater(sum(step > 0 for step in steps), 6)

    # -- ways to zero --------------------------------------------------------------------------------

    def test_zero_without_a_fresh_command(self):
        node = self.started()
        self.follow()
        self.commander.command = None
        wait_for(self.is_zero, "zero currents")
        wait_for(lambda: "no fresh command" in node.message("output"), "the reason")

    def test_zero_on_sigterm(self):
        node = self.started(watchdog=PATIENT)
        self.follow()
        written = node.end(signal.SIGTERM)
        self.assertTrue(self.is_zero())
        self.assertEqual(self.device.holding_at(ENABLE), [0])
        self.assertEqual(node.process.returncode, 0)
        self.assertNotIn("FATAL", written)

    def test_no_status_of_success_while_current_flows(self):
        node = self.started(watchdog=PATIENT)
        self.follow()
        self.device.holding.are_applied = False
        written = node.end(signal.SIGTERM)
        self.assertTrue(self.is_zero())
        self.assertNotEqual(node.process.returncode, 0)
        self.assertIn("FATAL", written)
        self.assertIn("1.50 A", written)

    def test_a_device_that_has_gone_at_zero_is_no_danger(self):
        node = self.started(watchdog=PATIENT)
        self.follow()
        wait_for(lambda: node.value("output", "zero measured") == "no", "current")
        self.commander.command = self.pattern(3, 0.0)
        wait_for(lambda: node.value("output", "zero measured") == "yes", "zero")
        self.device.stop()
        written = node.end(signal.SIGINT)
        self.assertEqual(node.process.returncode, 0)
        self.assertNotIn("FATAL", written)

    def test_zero_on_sigint(self):
        node = self.started(watchdog=PATIENT)
        self.follow()
        node.end(signal.SIGINT)
        self.assertTrue(self.is_zero())

    def test_zero_on_rosnode_kill(self):
        node = self.started(watchdog=PATIENT)
        self.follow()
        subprocess.run(["rosnode", "kill", node.name], check=True, stdout=subprocess.DEVNULL)
        node.wait_for_end()
        self.assertTrue(self.is_zero())

    def test_zero_first_when_the_link_is_back(self):
        node = self.started(watchdog=PATIENT)
        wait_for(self.vanishes_with_current, "a device that goes with its current")
        node.wait_for_level("link", ERROR)
        # The amplifier keeps what it was told last; commands go on, and must not act on return.
        self.assertFalse(self.is_zero())
        self.commander.command = None
        wait_for(lambda: int(node.value("link", "failures")) >= 3, "further attempts")
        self.device.holding.history.clear()
        self.device.start_tcp(self.port)
        self.wait_for_zero()
        self.assertEqual(self.device.holding.history[0], (ENABLE, [0]))
        node.wait_for_level("link", OK)
        self.follow()

    def vanishes_with_current(self):
        """Unless commands were late just then, and it was told zero."""
        self.follow()
        self.device.stop()
        if self.is_zero():
            self.device.start_tcp(self.port)
            return False
        return True

    def test_zero_when_the_amplifier_trips(self):
        node = self.started(watchdog=PATIENT)
        self.follow()
        self.device.input.setValues(TRIPPED, [1])
        self.wait_for_zero()
        wait_for(lambda: "tripped" in node.message("output"), "the reason")
        node.wait_for_level("output", ERROR)
        self.device.input.setValues(TRIPPED, [0])
        self.follow()

    def test_zero_after_commands_that_are_refused(self):
        node = self.started()
        for command, reason in (
            ([1.0] * 3, "3 currents for 24 coils"),
            ([math.nan] + [0.0] * (COILS - 1), "not finite"),
            ([math.inf] + [0.0] * (COILS - 1), "not finite"),
        ):
            self.follow()
            self.commander.command = command
            wait_for(self.is_zero, "zero currents")
            wait_for(lambda: reason in node.value("output", "last refusal"), reason)  # noqa: B023

    def test_what_is_not_applied_is_told_and_the_heartbeat_withheld(self):
        deviation = {"tolerance": 0.15, "beats": 20}
        node = self.started(watchdog=PATIENT, deviation=deviation)
        self.follow()
        self.device.holding.are_applied = False
        self.commander.command = None
        self.wait_for_zero()
        self.wait_for_deviation(node)
        self.assertEqual(node.level("output"), ERROR)
        self.assertIn("not measured", node.message("output"))
        heartbeat = self.device.holding_at(HEARTBEAT)
        measured = len(self.measured)
        wait_for(lambda: len(self.measured) > measured + 5, "further beats")
        self.assertEqual(self.device.holding_at(HEARTBEAT), heartbeat)

    @staticmethod
    def wait_for_deviation(node):
        """Until it is told; a link that is lost, as on a busy computer, is an error as well."""
        told = "coil 3 carries 1.50 A where 0.00 A are set"
        wait_for(lambda: told in node.message("output"), told)

    def test_a_deviation_that_only_a_watchdog_can_have_ended_stays(self):
        node = self.started(watchdog=PATIENT, deviation={"tolerance": 0.15, "beats": 20})
        self.follow()
        self.device.holding.are_applied = False
        self.commander.command = None
        self.wait_for_deviation(node)
        measured = len(self.measured)
        wait_for(lambda: len(self.measured) > measured + 100, "further beats")
        self.device.holding.are_applied = True
        self.commander.command = self.pattern(3, 0.0)
        wait_for(lambda: node.value("output", "zero measured") == "yes", "zero")
        measured = len(self.measured)
        wait_for(lambda: len(self.measured) > measured + 100, "further beats")
        self.commander.command = self.pattern(3, 1.5)
        wait_for(lambda: len(self.measured) > measured + 200, "further beats")
        self.assertTrue(self.is_zero())
        self.assertEqual(node.level("output"), ERROR)
        self.assertEqual(node.value("output", "deviations"), "1")

    def test_ends_at_zero_when_it_gets_no_memory(self):
        node = self.started(watchdog=PATIENT, memory_limit=50)
        self.follow()
        with contextlib.ExitStack() as links:
            for _ in range(100):
                with contextlib.suppress(OSError):
                    link = links.enter_context(hostile_peer.connect(node.name))
                    link.sendall(struct.pack("<I", 1 << 20))  # what there is room made for
            written = node.wait_for_end()
        self.assertTrue(self.is_zero())
        self.assertEqual(self.device.holding_at(ENABLE), [0])
        self.assertNotEqual(node.process.returncode, 0)
        self.assertIn("the node ends", written)

    def test_an_unattended_amplifier_must_be_accepted(self):
        parameters = rospy.get_param("/shipped/coil_driver")
        parameters["link"].update(port=self.port)
        del parameters["heartbeat_address"]
        self.device.start_tcp(self.port)
        refused = DriverNode("coil_driver", parameters)
        self.assertIn("unattended_amplifier", refused.wait_for_end())
        self.assertNotEqual(refused.process.returncode, 0)
        refused.close()
        accepted = DriverNode("coil_driver", {**parameters, "unattended_amplifier": "accepted"})
        self.addCleanup(accepted.close)
        wait_for(lambda: "unattended amplifier" in accepted.message("output"), "a warning")

    def test_a_second_commander_is_refused_by_name(self):
        node = self.started(watchdog=PATIENT)
        self.follow()
        other = subprocess.Popen(
            [
                "rostopic",
                "pub",
                "--substitute-keywords",
                "--rate=50",
                f"{NAMESPACE}/coil_command",
                f"{PACKAGE}/CoilCurrents",
                f"{{header: {{stamp: now}}, current: {self.pattern(3, -1.0)}}}",
            ],
            stdout=subprocess.DEVNULL,
        )
        self.addCleanup(other.wait)
        self.addCleanup(other.terminate)
        wait_for(lambda: self.is_refused_for_us(node.value("output", "last refusal")), "a refusal by name")
        self.assertEqual(node.value("output", "commander"), rospy.get_name())
        self.assertAlmostEqual(self.setpoints()[2], 1.5, delta=MILLI)
        self.commander.command = None
        wait_for(lambda: self.setpoints()[2] < -0.9, "the second one's turn")

    @staticmethod
    def is_refused_for_us(refusal):
        """On a busy computer it may be refused for its age, too."""
        return "rostopic" in refusal and rospy.get_name() + " commands" in refusal

    def test_stale_commands_are_refused(self):
        node = self.started()
        self.follow()
        self.commander.age = 1.0
        wait_for(self.is_zero, "zero currents")
        wait_for(lambda: "s old" in node.value("output", "last refusal"), "the reason")

    def test_zero_when_a_register_is_refused(self):
        field = {"unit": UNIT, "table": "input", "address": 190, "type": "int16", "scale": MILLI}
        node = self.started(currents=field)
        self.commander.command = self.pattern(3, 1.5)
        node.wait_for_level("link", ERROR)
        wait_for(lambda: "Illegal data address" in node.message("link"), "the reason")
        wait_for(lambda: int(node.value("link", "failures")) >= 3, "further attempts")
        self.wait_for_zero()
        self.assertEqual(self.measured, [])

    def test_garbage_is_never_taken_for_an_answer(self):
        server = RudeServer(self.port, bytes(range(1, 40)))
        self.addCleanup(server.close)
        node = self.start(response_timeout=0.1)
        self.commander.command = self.pattern(3, 1.5)
        node.wait_for_level("link", ERROR)
        wait_for(lambda: server.requests >= 3, "further attempts")
        self.assertEqual(self.measured, [])


if __name__ == "__main__":
    rospy.init_node("coil_driver_test")
    rostest.rosrun(PACKAGE, "coil_driver", CoilDriver, sys.argv)
