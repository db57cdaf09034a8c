"""Form grinding of pre-cut gears, one gap after the other (geometry.md 4)."""
