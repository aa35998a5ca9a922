"""The command line `lavender`: one file per verb, for parsing and printing only."""
