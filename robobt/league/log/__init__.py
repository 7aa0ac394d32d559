"""The league's log files."""
