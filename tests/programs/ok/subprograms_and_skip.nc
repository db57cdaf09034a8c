(final X-6. Z-4. C0.)
O0016 (G66, a skipped block, M99 P, GOTO)
G66 P0020 U2.
G00 X-2. Z-2.
/ M08
X-4.
G67
X-8.
M98 P0021
G00 X-99.
N50 GOTO 60
G00 X-98.
N60 M30
O0020 (moves on by #21 and comes back)
G00 U-#21
U#21
M99
O0021
G00 X-6. W-2.
M99 P50
