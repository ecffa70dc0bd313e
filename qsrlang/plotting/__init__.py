"""Pictures of mixtures, maps, searches and their statistics: plain data in, a matplotlib Figure out."""
