"""What an operator can do, and in which order."""
