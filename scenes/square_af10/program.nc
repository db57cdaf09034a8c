%
O0003 (SQUARE 10 A/F, TWO INSERTS)
N0010 G28 U0 W0 ;             X and Z to the reference point
N0020 G28 H0 V0 ;             work and tool spindle to the reference point
N0025 G54 G00 X21. Z3. ;      beside the blank
N0030 G51.2 P2 Q4 ;         work turns 2 times, tool 4 times
N0040 S300 ;                  work 300 rpm
N0050 G99 G01 X10. F1. ;      X = width across flats
N0060 G01 Z-12. F0.5 ;      along the whole length
N0100 G01 X21. F1. ;       retract
N0110 S0 ;                    stop
N0120 G50.2 ;                 gear box off
N0130 M30 ;
%
