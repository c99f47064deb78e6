"""Bounds of what a peer of ROS may send to a node in Python."""

import rospy.impl.tcpros_base as tcpros
from rosgraph.network import ROSHandshakeException
from rospy.exceptions import TransportTerminated

LONGEST_MESSAGE = 16 << 20  # [byte] as for the nodes in C++
LONGEST_HEADER = 1 << 20  # [byte]


class _BoundedSocket:
    """The beginning of what a peer sends: a header, and no more than it may have."""

    def __init__(self, socket):
        self._socket = socket
        self._left = LONGEST_HEADER

    def recv(self, size):
        """As of a socket."""
        content = self._socket.recv(size)
        self._left -= len(content)
        if self._left < 0:
            raise ROSHandshakeException(f"a header of more than {LONGEST_HEADER} bytes")
        return content


def bound_links():
    """From now on rospy ends a connection whose header or message is longer than it may be, instead of taking in
    whatever comes: it has no setting for that. Call before rospy.init_node()."""
    read_header = tcpros.read_ros_handshake_header
    receive = tcpros.recv_buff

    def read_bounded_header(sock, buffer, size):
        return read_header(_BoundedSocket(sock), buffer, size)

    def receive_bounded(sock, buffer, size):
        if buffer.tell() > LONGEST_MESSAGE:
            raise TransportTerminated(f"a message of more than {LONGEST_MESSAGE} bytes")
        return receive(sock, buffer, size)

    tcpros.read_ros_handshake_header = read_bounded_header
    tcpros.recv_buff = receive_bounded
