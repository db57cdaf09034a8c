"""A shop's regression suite: jobs that say what they must come to."""
