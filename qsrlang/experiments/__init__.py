"""Comparisons of search methods: scenarios, trials, statistics and tables."""
