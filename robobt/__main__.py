"""``python -m robobt`` is the command ``robobt``."""

from robobt.cli import app

if __name__ == "__main__":
    app(prog_name="robobt")
