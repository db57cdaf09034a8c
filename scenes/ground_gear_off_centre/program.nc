%
O0001 (FORM GRINDING M3 Z30, SINGLE INDEXING)
N0010 G28 V0 ;                      inclined axis first
N0020 G28 U0 W0 ;
N0030 G28 H0 ;                      work spindle into position control
N0040 #520=0.05 ;                   eccentricity e, mm
N0050 #521=70.0 ;                   its angle phi, degrees
N0060 #522=6.0 ;                    gap 1, degrees
N0070 #523=30 ;                     number of gaps
N0080 #524=82.5 ;                   root diameter
N0090 G54 G00 X130. Z40. ;          beside the blank
N0100 S3000 M03 ;                   wheel on
N0110 #1=0 ;
N0120 WHILE [#1 LT #523] DO1 ;
N0130 #2=#522+#1*360./#523 ;        direction of this gap
N0140 #3=#520*COS[#521-#2] ;        O1 towards the wheel
N0150 #4=#520*SIN[#521-#2] ;        and across
N0160 G00 C[-#2] ;
N0170 G00 Y#4 ;
N0180 G00 X[#524+2.*#3] ;           to depth, still beside the blank
N0190 G01 Z-72. F6000. ;            through the gap
N0200 G00 X130. ;
N0210 G00 Z40. ;
N0220 #1=#1+1 ;
N0230 END1 ;
N0240 M05 ;
N0250 G00 Y0. ;
N0260 M30 ;
%
