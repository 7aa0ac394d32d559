"""``python -m robobt`` is the command ``robobt``."""

from robobt.cli import main

if __name__ == "__main__":
    main()
