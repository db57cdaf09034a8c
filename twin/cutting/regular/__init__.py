"""The quick way for complete regular gears: a chart of every gap, proved to hold all of the cut."""
