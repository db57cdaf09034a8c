"""Two parts against each other: where their surfaces differ, and which figures changed."""
