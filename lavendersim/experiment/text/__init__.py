"""The text of a config: its tree with the line and column of every value; its defects.

PyYAML gives events (libyaml, where it was built with it); scalars, nodes and refusals are our own.
ruamel.yaml, which keeps marks and speaks YAML 1.2, was tried in their place (0.19.1, Python 3.11,
on the 111 shipped configs and the texts of `tests/configs/test_bad_configs.py`) and cannot do it:

- Its composer recurses: 100,000 nested brackets end in a RecursionError after 6 s. They are refused
  here in two milliseconds, at the 33rd bracket. Its events alone need 0.6 s to come so far, because
  its scanner first reads on to where a key might end, and 4 s for a list of 400,000 numbers.
- Its marks come from a scanner in Python: the configs compose in 1.4 s instead of 0.12 s, and a
  sweep's file is read again by every process.
- What it would replace, `scalars.resolve` and `Node`, is what a config adds to YAML 1.2: exact
  ratios (1/480), refused infinities, keys that are text whatever they look like, several defects of
  one file at once. Tags, anchors and duplicate keys would have to be refused from events all the
  same, and its words for a syntax error differ from those that `syntax` knows.
"""
