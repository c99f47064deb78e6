"""Tells what a program of this folder does where --help asks for it, before it does anything."""

import sys


def tell_help(text):
    """Ends the program after its help, where that is asked for."""
    if sys.argv[1:2] in (["-h"], ["--help"]):
        print(text.strip())
        sys.exit()
