"""Whether knowledge is consistent: graph -> claims -> search by two theories -> minimal conflicts -> relaxations."""
