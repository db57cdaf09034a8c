%
O0001 (SPUR GEAR M2 Z20, RIGHT-HAND HOB, ONE START)
N0010 G28 U0 W0 ;             X and Z to the reference point
N0020 G28 H0 V0 ;             work and tool spindle to the reference point
N0025 G54 G00 X50. Z20. ;     beside the blank
N0030 G81 T20 L1 ;            hob turns once, work turns 18 degrees
N0040 S300 ;                  hob 300 rpm
N0050 G99 G01 X35. F2. ;      to the root diameter, still beside the blank
N0060 G01 Z-38. F2. ;        one pass, 2 mm per turn of the work
N0100 G01 X50. F2. ;          retract
N0110 S0 ;                    stop the hob
N0120 G80 ;                   gear box off
N0130 M30 ;
%
