"""Ways to rank views by what they would show and what they cost, one file each."""
