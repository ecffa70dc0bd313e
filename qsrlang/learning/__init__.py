"""Observations to knowledge: what was seen where and when, its statistics, and densities learned from them."""
