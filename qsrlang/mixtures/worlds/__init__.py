"""Combinations of alternatives that hold together, and in which order each places its objects."""
