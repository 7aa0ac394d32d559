"""The league's network protocols: a world over SSL-Vision, and the simulator served to others."""
