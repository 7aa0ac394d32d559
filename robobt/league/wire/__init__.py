"""The league's packets: messages, sockets, addresses."""
