"""A peer of ROS that says what no library lets one say: any bytes on topics, services and connections."""

import contextlib
import itertools
import re
import socket
import struct
import threading
import time
import xmlrpc.client
import xmlrpc.server

import rosgraph
from calibration_client import wait_for
from links import receive, serve_each

CALLER = "/hostile"
NUMBERS = itertools.count()  # the master takes who comes from two addresses for two nodes, and forgets the first
PATIENCE = 60.0  # [s] of one answer, on however busy a computer


def framed(content):
    """Bytes behind their length, as ROS sends headers, messages and requests."""
    return struct.pack("<I", len(content)) + content


def header(**fields):
    return framed(b"".join(framed(f"{key}={value}".encode()) for key, value in fields.items()))


def receive_framed(link):
    return receive(link, struct.unpack("<I", receive(link, 4))[0])


class HostilePublisher:
    """Publishes bytes on a topic. `welcome(publisher, link)` answers each subscriber's header; without it, as it should
    be."""

    def __init__(self, topic, message_class, welcome=None):
        self._caller = f"{CALLER}_{next(NUMBERS)}"
        self._topic = topic
        self._class = message_class
        self._welcome = welcome or HostilePublisher.greet
        self._links = []
        self._lock = threading.Lock()
        self.visits = 0  # connections of subscribers so far
        self._listener = socket.create_server(("127.0.0.1", 0))
        serve_each(self._listener, self._serve)
        self._slave = xmlrpc.server.SimpleXMLRPCServer(("127.0.0.1", 0), logRequests=False, allow_none=True)
        self._slave.register_function(self._request_topic, "requestTopic")
        self._slave.register_function(lambda *_: [1, "", 0], "publisherUpdate")
        threading.Thread(target=self._slave.serve_forever, daemon=True).start()
        self._uri = f"http://127.0.0.1:{self._slave.server_address[1]}/"
        self._master = xmlrpc.client.ServerProxy(rosgraph.get_master_uri())
        self._master.registerPublisher(self._caller, topic, message_class._type, self._uri)

    def _request_topic(self, *_):
        return [1, "", ["TCPROS", "127.0.0.1", self._listener.getsockname()[1]]]

    def _serve(self, link):
        with contextlib.suppress(OSError, EOFError):
            receive_framed(link)
            self.visits += 1
            self._welcome(self, link)
            with self._lock:
                self._links.append(link)

    def greet(self, link, **changes):
        fields = {
            "callerid": self._caller,
            "md5sum": self._class._md5sum,
            "type": self._class._type,
            "topic": self._topic,
            "latching": "0",
            "message_definition": "",
        }
        link.sendall(header(**{**fields, **changes}))

    def wait_for_visits(self, count):
        wait_for(lambda: self.visits >= count, f"{count} subscribers of {self._topic}")

    def links(self):
        with self._lock:
            return list(self._links)

    def send(self, content):
        """Sends bytes as they are to every subscriber."""
        for link in self.links():
            with contextlib.suppress(OSError):
                link.sendall(content)

    def publish(self, content):
        self.send(framed(content))

    def close(self):
        with contextlib.suppress(OSError, xmlrpc.client.Error):
            self._master.unregisterPublisher(self._caller, self._topic, self._uri)
        self._slave.shutdown()
        self._slave.server_close()
        self._listener.close()
        for link in self.links():
            link.close()


def connect(node):
    """A link to where a node serves its topics and services."""
    slave = xmlrpc.client.ServerProxy(rosgraph.Master(CALLER).lookupNode(node))
    code, message, protocol = slave.requestTopic(CALLER, "/rosout", [["TCPROS"]])
    if code != 1:
        raise OSError(message)
    _, host, port = protocol
    return socket.create_connection((host, port), timeout=PATIENCE)


def meet(node):
    """Waits until a node answers who asks for its log."""
    with connect(node) as link:
        link.sendall(header(callerid=CALLER, topic="/rosout", type="rosgraph_msgs/Log", md5sum="*"))
        receive_framed(link)


def call(service, content, send_length=None):
    """Calls a service by a request of any bytes; returns whether it succeeded, and the bytes of its answer."""
    uri = rosgraph.Master(CALLER).lookupService(service)
    host, port = re.match(r"rosrpc://(.*):(\d+)", uri).groups()
    with socket.create_connection((host, int(port)), timeout=PATIENCE) as link:
        link.sendall(header(callerid=CALLER, service=service, md5sum="*", type="*"))
        receive_framed(link)
        length = len(content) if send_length is None else send_length
        link.sendall(struct.pack("<I", length) + content)
        if send_length is not None:
            return False, b""
        return receive(link, 1) == b"\1", receive_framed(link)


def largest_memory(pid):
    """That a process ever had resident [MB]."""
    with open(f"/proc/{pid}/status", encoding="ascii") as status:
        return int(re.search(r"VmHWM:\s*(\d+) kB", status.read()).group(1)) * 1024 / 1e6


def flood(link_or_publisher, content, seconds):
    end = time.monotonic() + seconds
    count = 0
    while time.monotonic() < end:
        link_or_publisher.send(content)
        count += 1
    return count
