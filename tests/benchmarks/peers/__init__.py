"""The same scenes on lavender and on engines that pip installs: cost beside error."""
