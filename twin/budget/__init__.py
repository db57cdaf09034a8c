"""What each thing that is not ideal does to the part, alone and together: the error budget of a job."""
