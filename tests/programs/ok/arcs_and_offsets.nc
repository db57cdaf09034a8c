(final X50. Z2.)
O0015 (arcs by R and by I K, work offsets, a local system, inches)
G10 L2 P2 X-100. Z-60.
G10 P4 X0.2
T0104
G55 G00 X50. Z2.
G01 X20. Z0 F200
G03 X30. Z-5. R5.
G01 Z-10.
G02 X40. Z-15. I5. K0
G52 Z-15.
G01 Z-5.
G03 U10. W-5. I0 K-5.
G52 Z0
G20
G01 X2.1 F10.
G21
G00 X50. Z2.
M30
