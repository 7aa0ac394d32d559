"""Files a person writes or reads: YAML with positions, errors that name file and field, atomic writes."""
