%
O0001 (SPUR GEAR M2 Z20 BEHIND A HUB)
N0010 G28 U0 W0 ;             X and Z to the reference point
N0020 G28 H0 V0 ;             work and tool spindle to the reference point
N0030 G54 G00 X50. Z10. ;     beside the teeth
N0040 G81 T20 L1 ;            hob turns once, work turns 18 degrees
N0050 S300 ;                  hob 300 rpm
N0060 G99 G01 X35. F2. ;      to the root diameter, still beside the teeth
N0070 G01 Z-43. F0.7 ;        one pass, 0.7 mm per turn of the work: feed marks of 0.6 um
N0080 G01 X50. F2. ;          retract
N0090 S0 ;                    stop the hob
N0100 G80 ;                   gear box off
N0110 M30 ;
%
