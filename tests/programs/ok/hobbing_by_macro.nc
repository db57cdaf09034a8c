(final X90. Z6.)
O0014 (gear in two cuts: the depth in a macro)
G28 U0 W0
G28 H0 V0
G00 X90. Z6.
G65 P9100 T20 D1 X90. Z6. I40. K-26. F30.
G65 P9100 T20 D1 X90. Z6. I35. K-26. F24.
M30
O9100 (T teeth #20, D starts #7, X Z start #24 #26, I diameter #4, K end #6, F feed #9)
G81 T#20 L#7
S240
G01 X#4 F200
Z#6 F#9
X#24 F500
G00 Z#26
S0
G80
M99
