"""``python -m kbga``: the command ``kbga-bench``."""

from suite.cli import main

if __name__ == "__main__":
    main()
