#!/usr/bin/python3
"""The plugin that rviz loads brings neither database nor drivers nor solver with it, nor a second Qt:
links_messages_only.py LIBRARY"""

import re
import subprocess
import sys

OWN = re.compile(r"libsac_\w+\.so")
QT = re.compile(r"libQt(\d)Widgets")
UNWANTED = re.compile(r"lib(sqlite\w*|SQLiteCpp|modbus|ceres)\b[^ ]*", re.IGNORECASE)


def main(library):
    """Exit status: 0 where nothing unwanted is linked, directly or not."""
    needed = subprocess.run(["ldd", library], check=True, stdout=subprocess.PIPE, text=True).stdout
    # librviz is among what is needed, with the Qt that it is built with.
    if "not found" in needed or len(set(QT.findall(needed))) != 1:
        print(f"{library} cannot be loaded by rviz:\n{needed}")
        return 1
    found = sorted({match.group(0) for pattern in (OWN, UNWANTED) for match in pattern.finditer(needed)})
    for name in found:
        print(f"{library} links {name}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
