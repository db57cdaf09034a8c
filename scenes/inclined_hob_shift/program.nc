%
O0011 (HELICAL GEAR M2 Z20 20 DEG RIGHT, HOB SHIFTED ALONG Y WHILE IT CUTS)
N0010 G28 V0 ;                inclined slide to its reference point, first
N0012 G28 U0 W0 ;             then X and Z
N0014 G28 H0 ;                work spindle
N0020 G54 G00 X50. Z20. Y-3. ; beside the blank, hob 3 mm low
N0030 G81 T20 L1 Q2. P20. ;   hob turns once, work 18 degrees; normal module 2, helix 20 degrees
N0040 S300 ;                  hob 300 rpm
N0050 G99 G01 X37.567 F2. ;   root diameter d - 2.5 m_n
N0055 G01 Z16. F2. ;
N0060 G01 Z-40. V6. H16.152 F2. ; hob 6 mm up, work on by 360 x 6 x cos 20 / (pi x 20 x 2) degrees
N0100 G01 X50. F2. ;          retract
N0110 S0 ;
N0120 G80 ;
N0130 M30 ;
%
