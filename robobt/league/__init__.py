"""The league's network protocols: a world over SSL-Vision and commands, our simulator served to others."""
