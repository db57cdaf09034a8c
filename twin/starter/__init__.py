"""First drafts: a job and its program for a gear or a polygon, from its catalogue data."""
