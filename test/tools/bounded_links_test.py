#!/usr/bin/python3
"""Tests of spherical_actuator_calibration.bounded_links: rospy takes in no more than a header or a message may have."""

import io
import socket
import struct
import threading
import unittest

import rospy.impl.tcpros_base as tcpros
from rosgraph.network import ROSHandshakeException, encode_ros_handshake_header
from rospy.exceptions import TransportTerminated
from spherical_actuator_calibration.bounded_links import LONGEST_HEADER, LONGEST_MESSAGE, bound_links

bound_links()
CHUNK = 65536


class Sender:
    """Sends until nobody listens any more."""

    def __init__(self, begin, count):
        self.link, peer = socket.socketpair()
        self.link.settimeout(60.0)
        threading.Thread(target=self._send, args=(peer, begin, count), daemon=True).start()

    @staticmethod
    def _send(peer, begin, count):
        try:
            peer.sendall(begin)
            for _ in range(count // CHUNK):
                peer.sendall(bytes(CHUNK))
        except OSError:
            pass


class BoundedLinks(unittest.TestCase):
    """What comes is bounded, whatever was announced."""

    def test_a_good_header_is_read(self):
        content = encode_ros_handshake_header({"callerid": "/someone", "definition": "x" * 100000})
        sender = Sender(content, 0)
        header = tcpros.read_ros_handshake_header(sender.link, io.BytesIO(), CHUNK)
        self.assertEqual(header["callerid"], "/someone")

    def test_a_header_ends_at_its_bound(self):
        sender = Sender(struct.pack("<I", 900000000), 8 * LONGEST_HEADER)
        buffer = io.BytesIO()
        with self.assertRaises(ROSHandshakeException):
            tcpros.read_ros_handshake_header(sender.link, buffer, CHUNK)
        self.assertLessEqual(buffer.tell(), LONGEST_HEADER)

    def test_a_message_ends_at_its_bound(self):
        sender = Sender(struct.pack("<I", 300000000), 4 * LONGEST_MESSAGE)
        buffer = io.BytesIO()
        with self.assertRaises(TransportTerminated):
            while buffer.tell() < 3 * LONGEST_MESSAGE:
                tcpros.recv_buff(sender.link, buffer, CHUNK)
        self.assertLessEqual(buffer.tell(), LONGEST_MESSAGE + CHUNK)


if __name__ == "__main__":
    unittest.main()
