"""Blocks of code of a page, and what an invisible comment before a block says about how it is run.

    <!-- block: own terminals -->             each command in a terminal of its own: the first one goes on, beside the
                                             blocks that follow, until others begin; the last one ends, if it is another
    <!-- block: own terminals, until TEXT --> as soon as the last one has said TEXT, Ctrl-C ends them
    <!-- block: alone -->                     after the terminals of earlier blocks have been closed
    <!-- block: listed -->                    calls of ctest name tests that are there; they run anyway
    <!-- block: status 1; REASON -->          the last command ends with that status
    <!-- block: run by NAME; REASON -->       not here: NAME is a test, or .ci/run where that runs it

A block without such a comment runs here, and every one of its commands succeeds.
"""

import dataclasses
import re

FENCE = re.compile(r"^```(\w*)$")
COMMENT = re.compile(r"^<!-- block: (.+) -->$")
TERMINALS = re.compile(r"own terminals(?:, until (?P<until>.+))?")
ELSEWHERE = re.compile(r"run by (?P<test>\S+); (?P<reason>.+)")
STATUS = re.compile(r"status (?P<status>\d); .+")
ALONE = "alone"
LISTED = "listed"


@dataclasses.dataclass(frozen=True)
class Block:
    """One block between fences, with the line it begins at."""

    line: int
    language: str
    text: str
    how: str = ""

    @property
    def terminals(self):
        return TERMINALS.fullmatch(self.how)

    @property
    def elsewhere(self):
        return ELSEWHERE.fullmatch(self.how)

    @property
    def status(self):
        """Status that the last command ends with."""
        told = STATUS.fullmatch(self.how)
        return int(told["status"]) if told else 0

    def commands(self):
        """Commands of a shell, without comments, continued lines in one."""
        lines = (line for line in self.text.replace("\\\n", " ").splitlines())
        return [line for line in lines if line.strip() and not line.lstrip().startswith("#")]


class PageError(Exception):
    """A page that cannot be read; the text names the line."""


def blocks_of(text):
    """All blocks of a page in their order. Raises PageError for a comment that says nothing known or stands alone."""
    blocks, how, begin, inside = [], "", None, []
    for number, line in enumerate(text.splitlines(), 1):
        fence = FENCE.match(line)
        if begin is not None and line == "```":
            blocks.append(Block(begin[0], begin[1], "\n".join(inside) + "\n", how))
            how, begin, inside = "", None, []
        elif begin is not None:
            inside.append(line)
        elif fence:
            begin = (number, fence.group(1))
        elif how and line.strip():
            raise PageError(f"line {number}: no block follows the comment before it.")
        elif comment := COMMENT.match(line):
            how = comment.group(1)
            if how not in (ALONE, LISTED) and not any(form.fullmatch(how) for form in (TERMINALS, ELSEWHERE, STATUS)):
                raise PageError(f'line {number}: nothing is known of "{how}".')
    if begin is not None:
        raise PageError(f"line {begin[0]}: the block has no end.")
    return blocks
