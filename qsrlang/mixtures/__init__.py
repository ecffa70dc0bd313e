"""From relations and poses to Gaussian mixtures."""
