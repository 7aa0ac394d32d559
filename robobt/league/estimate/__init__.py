"""From detections to states: filter and clocks."""
