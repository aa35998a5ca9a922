"""A package, so that `tests` means this folder: the wheel of dartpy brings one of the same name."""
