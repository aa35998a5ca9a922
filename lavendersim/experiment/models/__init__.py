"""What can be written in a config: a pydantic model of every section."""
