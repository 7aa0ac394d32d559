"""The kick of RoboBulls, the paper's own team software, as its published code has it."""
