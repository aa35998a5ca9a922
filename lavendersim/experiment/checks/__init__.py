"""What no single value shows: rules between values, names that must exist; the sentences."""
