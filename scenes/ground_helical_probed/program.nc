%
O0001 (FORM GRINDING M3 Z30 15 DEG RIGHT, AS IF IT STOOD TRUE)
N0010 G28 V0 ;                      inclined axis first
N0020 G28 U0 W0 ;
N0030 G28 H0 ;                      work spindle into position control
N0040 #522=6.0 ;                    gap 1 in the front face, degrees
N0050 #523=30 ;                     number of gaps
N0060 #524=85.675 ;                 root diameter
N0070 #525=0.3295386 ;              turn of the gaps, degrees per mm
N0080 G54 G98 G00 X134. Z30. ;      beside the blank
N0090 S3000 M03 ;                   wheel on
N0100 #1=0 ;
N0110 WHILE [#1 LT #523] DO1 ;
N0120 #2=-#522-#1*360./#523 ;       this gap before the wheel, at the front face
N0130 G00 C[#2-30.*#525] ;
N0140 G00 X#524 ;                   to depth, still beside the gear
N0150 G01 Z-84. C[#2+84.*#525] F6000. ;   along the gap
N0160 G00 X134. ;
N0170 G00 Z30. ;
N0180 #1=#1+1 ;
N0190 END1 ;
N0200 M05 ;
N0210 G28 U0 ;
N0220 M30 ;
%
