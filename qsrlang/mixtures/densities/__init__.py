"""What statements say of a place: polar densities, regions and fits, and where they hold."""
