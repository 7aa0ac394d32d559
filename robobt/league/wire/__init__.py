"""The league's packets: messages, sockets, addresses, links to simulators."""

from robobt.config.extras import need

need("league", "google.protobuf")
