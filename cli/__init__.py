"""The command line: arguments enter, text leaves. Parsing and printing only; one file per verb."""
