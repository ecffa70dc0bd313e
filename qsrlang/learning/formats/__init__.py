"""Files of observations, read into one schema: our own tables, and public data sets."""
