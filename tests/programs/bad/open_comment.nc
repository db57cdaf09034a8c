(HT9004 2:5)
G00 (never closed
M30
