"""What a run leaves on the disk: one folder, complete or not at all."""
