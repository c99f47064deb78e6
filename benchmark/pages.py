"""Writes what one run measured into the pages, between two comments each."""

import datetime
import os
import pathlib
import subprocess

BEGIN = "<!-- measured by scripts/benchmark -->"
END = "<!-- end of what was measured -->"


def replaced(text, measured):
    """The text with other words between its two comments, which must be there once, in this order."""
    if text.count(BEGIN) != 1 or text.count(END) != 1 or text.index(BEGIN) > text.index(END):
        raise ValueError(f"there must be one {BEGIN}, and one {END} behind it")
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}\n{measured.strip()}\n{END}{after}"


def table(columns, rows):
    lines = [columns, ["---"] * len(columns), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def processor():
    """Its name, as Linux tells it."""
    for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        name, _, value = line.partition(":")
        if name.strip() == "model name":
            return value.strip()
    return "unknown processor"


def commit(source):
    """Of the sources that were measured; says where they were changed since."""
    def git(*arguments):
        return subprocess.run(["git", "-C", source, *arguments], check=True, capture_output=True, text=True).stdout
    changed = any(not line.startswith("??") for line in git("status", "--porcelain").splitlines())
    return git("rev-parse", "--short", "HEAD").strip() + (" with changes" if changed else "")


def provenance(source):
    """Where numbers come from, a sentence."""
    return (f"Measured on {datetime.date.today().isoformat()} on {processor()}, {os.cpu_count()} processors, "
            f"commit {commit(source)}.")


def write(path, measured):
    page = pathlib.Path(path)
    page.write_text(replaced(page.read_text(encoding="utf-8"), measured), encoding="utf-8")
