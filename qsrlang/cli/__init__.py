"""The command `qsr`: one verb per file."""
