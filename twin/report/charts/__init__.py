"""What an inspection measured and a recording holds, drawn."""
