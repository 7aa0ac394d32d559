"""Fields that nobody knows: drawn, played on, identified, scored."""
