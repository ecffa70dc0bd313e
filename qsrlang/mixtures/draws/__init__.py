"""Worlds as draws: whole scenes from the true densities, weighed by what is assumed."""
