(final X0. Z-30.)
O0013 (a quarter of an ellipse in steps of 5 degrees: half axes #1 along Z, #2 along X)
#1=30.
#2=12.
#3=0
G98 G00 X0 Z0
WHILE [#3 LE 90] DO 1
G01 X[2*#2*SIN[#3]] Z[#1*COS[#3]-#1] F300
#3=#3+5
END 1
IF [ABS[#5041-2*#2] GT 0.001] THEN #3000=1 (NOT AT THE END OF THE ELLIPSE)
G65 P9013 X0 Z-30. F500
M30
O9013 (back in two steps)
IF [#24 EQ #0] GOTO 90
G00 X[#24+2.]
X#24 Z#26
N90 M99
