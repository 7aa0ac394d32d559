"""robobt: behaviour trees for robot soccer, with skills written by hand or learned."""

__version__ = "0.1.0"
