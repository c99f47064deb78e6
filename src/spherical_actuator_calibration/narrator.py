"""What is told to people, sentence by sentence. No ROS."""

import re

NUMBER = re.compile(r"[-+\u2212]?\d+(\.\d+)?")


class Narrator:
    """Tells what is new; what goes on for a while it tells once. Who inherits it has _tell(sentence)."""

    def __init__(self):
        self._said = set()  # since the last change: sentences without their numbers

    def _tell(self, sentence):
        raise NotImplementedError

    def say(self, sentence):
        """Says what is new; from here on, all that goes on may be said once more."""
        self._tell(sentence)
        self._said = {NUMBER.sub("#", sentence)}

    def say_once(self, sentence):
        """Says what goes on for a while, once, however its numbers change."""
        shape = NUMBER.sub("#", sentence)
        if shape not in self._said:
            self._said.add(shape)
            self._tell(sentence)
