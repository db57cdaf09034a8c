%
O0001 (FORM GRINDING M3 Z30 AS IF IT STOOD TRUE, SINGLE INDEXING)
N0010 G28 V0 ;                      inclined axis first
N0020 G28 U0 W0 ;
N0030 G28 H0 ;                      work spindle into position control
N0040 #522=6.0 ;                    gap 1, degrees
N0050 #523=30 ;                     number of gaps
N0060 #524=82.5 ;                   root diameter
N0070 G54 G98 G00 X130. Z30. ;      beside the blank
N0080 S3000 M03 ;                   wheel on
N0090 #1=0 ;
N0100 WHILE [#1 LT #523] DO1 ;
N0110 G00 C[-#522-#1*360./#523] ;   this gap before the wheel
N0120 G00 X#524 ;                   to depth, still beside the gear
N0130 G01 Z-84. F6000. ;            through the gap
N0140 G00 X130. ;
N0150 G00 Z30. ;
N0160 #1=#1+1 ;
N0170 END1 ;
N0180 M05 ;
N0190 G28 U0 ;
N0200 M30 ;
%
