"""Where every cutting edge of a tool is."""
