"""What is wrong with a machine, its clamping or its hob: a job's `[faults]`, and where each enters."""
