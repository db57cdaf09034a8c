"""One module for every family of codes: a checked block becomes its commands."""
