#!/usr/bin/python3
"""What starts obeys signals, whichever of its requests the master does not answer any more, and where there is none."""

import os
import pathlib
import signal
import socketserver
import subprocess
import threading
import time
import unittest
import xmlrpc.server

import yaml
from rosmaster.master_api import ROSMasterHandler

PROGRAMS = pathlib.Path(os.environ["PROGRAMS"])
CONFIG = pathlib.Path(os.environ["SOURCE"]) / "config"
NOWHERE = "http://127.0.0.1:1"  # where no master listens
PATIENCE = 60.0  # [s]
LAST = ("registerSubscriber", "/coil_command")  # of the start: the control loop runs from there on
NEVER = 10**6


def environment(master):
    return {**os.environ, "ROS_MASTER_URI": master, "ROS_IP": "127.0.0.1"}


class Server(socketserver.ThreadingMixIn, xmlrpc.server.SimpleXMLRPCServer):
    daemon_threads = True

    def handle_error(self, request, client_address):
        """A driver that has ended hears no answer."""


class Master:
    """A master of ROS in this process, which hangs from one of the driver's requests on, counted from 1."""

    def __init__(self, hangs_at):
        self._hangs_at = hangs_at
        self._handler = ROSMasterHandler(1)
        self._lock = threading.Lock()
        self.requests = []
        self.hangs = threading.Event()
        self.has_started = threading.Event()
        self._end = threading.Event()
        description = yaml.safe_load((CONFIG / "pm_spherical_8x24.yaml").read_text())
        parameters = yaml.safe_load((CONFIG / "coil_driver.yaml").read_text())
        parameters["link"]["port"] = 1  # nobody listens there
        self._handler.setParam("/test", "/actuator", description["actuator"])
        self._handler.setParam("/test", "/coil_driver", parameters)
        self._server = Server(("127.0.0.1", 0), logRequests=False, allow_none=True)
        self.uri = f"http://127.0.0.1:{self._server.server_address[1]}"
        self._handler._ready(self.uri)  # pylint: disable=protected-access
        self._server.register_instance(self)
        threading.Thread(target=self._server.serve_forever, daemon=True).start()

    def _dispatch(self, method, parameters):
        with self._lock:
            self.requests.append((method, *parameters[1:2]))
            count = len(self.requests)
        if count >= self._hangs_at:
            self.hangs.set()
            self._end.wait()
        if self.requests[-1] == LAST:
            self.has_started.set()
        return getattr(self._handler, method)(*parameters)

    def close(self):
        self._end.set()
        self._server.shutdown()
        self._server.server_close()


class Trial:
    """A driver that is ended when its master hangs."""

    def __init__(self, hangs_at):
        self.master = Master(hangs_at)
        self.driver = subprocess.Popen(
            [PROGRAMS / "coil_driver"],
            env=environment(self.master.uri),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def signal(self, reached):
        """Once the master has come so far."""
        assert reached.wait(PATIENCE), "the driver does not ask so often"
        self.driver.send_signal(signal.SIGTERM)

    def ends(self, until):
        """Whether it does, before a time of the monotonic clock [s]."""
        try:
            self.driver.wait(max(until - time.monotonic(), 0.0))
            return True
        except subprocess.TimeoutExpired:
            return False
        finally:
            self.driver.kill()
            self.driver.wait()
            self.master.close()


class HangingMaster(unittest.TestCase):
    def test_a_driver_that_starts_beside_it_ends(self):
        undisturbed = Trial(NEVER)
        undisturbed.signal(undisturbed.master.has_started)
        self.assertTrue(undisturbed.ends(time.monotonic() + PATIENCE))
        requests = undisturbed.master.requests
        trials = [Trial(number) for number in range(1, requests.index(LAST) + 2)]
        for trial in trials:
            trial.signal(trial.master.hangs)
        until = time.monotonic() + PATIENCE
        self.assertEqual([request for trial, request in zip(trials, requests) if not trial.ends(until)], [])

class NoMaster(unittest.TestCase):
    def register_frames(self, *options):
        """Once it has told that it waits."""
        process = subprocess.Popen(
            [PROGRAMS / "register_frames", *options],
            env=environment(NOWHERE),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        self.assertIn("Failed to contact master", process.stderr.readline())
        return process

    def test_who_takes_poses_live_ends_at_a_signal(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            for options in ((), ("--actuator", CONFIG / "pm_spherical_8x24.yaml")):
                with self.subTest(signal=number, options=options):
                    process = self.register_frames(*options)
                    process.send_signal(number)
                    self.assertEqual(process.wait(PATIENCE), 1)


if __name__ == "__main__":
    unittest.main()
