"""Worlds as Gaussians: equations, their solution, and probabilities without draws."""
