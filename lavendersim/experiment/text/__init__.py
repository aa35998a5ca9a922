"""The text of a config: its tree with the line and column of every value; its defects."""
