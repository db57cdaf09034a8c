%
O0002 (HELICAL GEAR M2 Z20 BETA 20 RIGHT, RIGHT-HAND HOB)
N0010 G28 U0 W0
N0020 G28 H0 V0
N0025 G54 G00 X54. Z26. ;     beside the blank
N0030 G81 T20 L1 Q2. P20. ; gear box with helical compensation
N0040 S300
N0050 G99 G01 X37.567 F2. ;   to the root diameter, still beside the blank
N0060 G01 Z-46. F2. ;         one pass, 2 mm per turn of the work
N0100 G01 X54. F2. ;          retract
N0110 S0
N0120 G80
N0130 M30
%
