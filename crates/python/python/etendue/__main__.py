"""The command ``etendue``: the program itself."""

import signal
import sys

from . import _etendue


def main():
    # Ctrl-C ends the program with the operating system's default action.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_etendue.main(["etendue", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
