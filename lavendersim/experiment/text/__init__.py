"""The text of a config: its tree with the line and column of every value; its defects.

PyYAML gives events (libyaml, where it was built with it); scalars, nodes and refusals are our own.
Why no library composes them: docs/architecture.md, "Reading YAML".
"""
