"""Results of trials and their summaries."""
