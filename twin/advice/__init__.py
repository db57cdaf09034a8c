"""What a job and its program together say before any metal is cut."""
