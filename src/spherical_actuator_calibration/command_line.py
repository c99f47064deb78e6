"""Command lines of the programs in Python, as strict as those of the programs in C++."""

import argparse
import itertools
import sys


class _Parser(argparse.ArgumentParser):
    """Takes names of options as they are, and each once unless it gathers values."""

    def __init__(self, program, description):
        super().__init__(
            prog=program,
            description=description,
            formatter_class=argparse.RawDescriptionHelpFormatter,
            allow_abbrev=False,
        )
        self._gathering = set()

    def add_argument(self, *names, **settings):
        if settings.get("action") == "append":
            self._gathering.update(names)
        return super().add_argument(*names, **settings)

    def parse_args(self, args=None, namespace=None):
        words = sys.argv[1:] if args is None else list(args)
        given = set()
        for word in itertools.takewhile(lambda word: word != "--", words):
            name = word.partition("=")[0]
            if name in given and name not in self._gathering:
                self.error(f"{name} is given more than once")
            if name.startswith("--"):
                given.add(name)
        return super().parse_args(words, namespace)

    def error(self, message):
        super().error(f"{message}; --help tells the options")


def parser(program, description):
    """Of one program; what it cannot take ends it with the exit status 2. `description` is printed as it stands."""
    return _Parser(program, description)
