"""What the recorder of a session has received, as it and the publishers tell of their connections."""

import xmlrpc.client

import rosgraph
import rospy
from calibration_client import wait_for


def _nodes():
    """Names of publishers by topic, and the name of the recorder or None."""
    publishers, subscribers, _ = rosgraph.Master(rospy.get_name()).getSystemState()
    listeners = {node for _, nodes in subscribers for node in nodes}
    return dict(publishers), next((node for node in listeners if node.endswith("/record")), None)


def _ask(node, question):
    """Answer of a node about its connections."""
    uri = rosgraph.Master(rospy.get_name()).lookupNode(node)
    answer = getattr(xmlrpc.client.ServerProxy(uri), question)(rospy.get_name())
    # roscpp gives its statistics without the code of success and the message before them.
    return answer[2] if answer[0] == 1 else answer


def sent(topic):
    """Messages that each publisher of a topic has sent to the recorder; None while one is not connected."""
    publishers, recorder = _nodes()
    counts = []
    for node in publishers.get(topic, ()):
        links = {link[0] for link in _ask(node, "getBusInfo") if link[1:3] == [recorder, "o"] and link[4] == topic}
        statistics = next((each[1] for each in _ask(node, "getBusStats")[0] if each[0] == topic), [])
        messages = [link[3] for link in statistics if link[0] in links]
        if not messages:
            return None
        counts += messages
    return counts or None


def received(topic):
    """Messages of a topic that the recorder has received: it writes them, whenever it ends."""
    _, recorder = _nodes()
    links = next((each[1] for each in _ask(recorder, "getBusStats")[1] if each[0] == topic), [])
    return sum(link[2] for link in links)


def wait_until_connected(topics):
    """Until every publisher of every topic sends to the recorder."""
    for topic in topics:
        wait_for(lambda: sent(topic) is not None, f"the recorder of {topic}")  # noqa: B023


def wait_until_received(topics):
    """Until the recorder has all that was sent to it before this call."""
    for topic in topics:
        count = sum(sent(topic))
        wait_for(lambda: received(topic) >= count, f"{count} recorded messages of {topic}")  # noqa: B023
