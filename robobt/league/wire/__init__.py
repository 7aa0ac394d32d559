"""The league's packets: messages, sockets, addresses, links to simulators."""
