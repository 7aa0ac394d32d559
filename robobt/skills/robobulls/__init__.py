"""The paper's own team software, RoboBulls, as its published code behaves."""
