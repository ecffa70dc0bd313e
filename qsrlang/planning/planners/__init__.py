"""Ways to choose the next pose, behind one protocol: the paper's three, and those that keep a belief."""
