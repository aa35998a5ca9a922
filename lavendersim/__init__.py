"""lavender."""
