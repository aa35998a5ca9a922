"""The configs below `bad` are read by test_bad_configs.py; they are no experiments to run."""

collect_ignore_glob = ["bad/*/*"]
