"""From detections to states: filters and clocks."""
