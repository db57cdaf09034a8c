%
O9810 (CIRCLE THROUGH A BAND: G65 P9810 A points D diameter Q R F)
(A  touches, evenly spaced about the turn, 3 to 99)
(D  diameter of the band, nominal; Q, R  begins Q outside of it and gives up R inside, in radius)
(F  feed of the touch, mm/min)
(#500 = 0 good, else number of the alarm; #501 touches made; #502 X of the last one, radius)
(#511, #512 centre x1, y1 by the patent; #513 radius; #514 e; #515 phi; #516 out of round)
(#600+i radius L of touch i, #700+i angle C of it)
#500=9 ;
#501=0 ;
#502=#0 ;
IF [#1 LT 3] GOTO 93 ;
IF [#1 GT 99] GOTO 93 ;
#31=#5041 ;                         where X came from, diameter
#32=#7+2.*#17 ;                     begin
#33=#7-2.*#18 ;                     end
#2=1 ;
WHILE [#2 LE #1] DO1 ;
#3=360.*[#2-1]/#1 ;
G00 C#3 ;
G00 X#32 ;
G31 X#33 F#9 ;
#502=#5061/2. ;
IF [#5061 LE #33+0.002] GOTO 91 ;
IF [#5061 GE #32-0.1] GOTO 92 ;
#[600+#2]=#5061/2. ;
#[700+#2]=#3 ;
#501=#2 ;
G00 X#32 ;
#2=#2+1 ;
END1 ;
G00 X#31 ;
(formulas 1 and 2 of the patent; the probe stands at -C as the part sees it)
#4=0 ;                              sum x
#5=0 ;                              sum y
#6=0 ;                              sum xx
#8=0 ;                              sum xy
#10=0 ;                             sum yy
#11=0 ;                             sum xxx + xyy
#12=0 ;                             sum xxy + yyy
#2=1 ;
WHILE [#2 LE #1] DO1 ;
#14=#[600+#2]*COS[#[700+#2]] ;
#15=-#[600+#2]*SIN[#[700+#2]] ;
#16=#14*#14+#15*#15 ;
#4=#4+#14 ;
#5=#5+#15 ;
#6=#6+#14*#14 ;
#8=#8+#14*#15 ;
#10=#10+#15*#15 ;
#11=#11+#14*#16 ;
#12=#12+#15*#16 ;
#2=#2+1 ;
END1 ;
#20=#1*#6-#4*#4 ;                   A
#21=#1*#8-#4*#5 ;                   B
#22=#1*#11-[#6+#10]*#4 ;            C
#23=#1*#10-#5*#5 ;                  D
#24=#1*#12-[#6+#10]*#5 ;            E
#25=[#24*#21-#22*#23]/[#20*#23-#21*#21] ;
#26=[#20*#24-#21*#22]/[#21*#21-#20*#23] ;
#27=-[#6+#10+#25*#4+#26*#5]/#1 ;
#511=-#25/2. ;
#512=-#26/2. ;
#513=SQRT[#511*#511+#512*#512-#27] ;
#514=SQRT[#511*#511+#512*#512] ;
#515=0 ;
IF [#514 EQ 0] GOTO 50 ;
#515=ATAN[#512]/[#511] ;
N50 #28=-999. ;                     how round the band is
#29=999. ;
#2=1 ;
WHILE [#2 LE #1] DO1 ;
#14=#[600+#2]*COS[#[700+#2]]-#511 ;
#15=-#[600+#2]*SIN[#[700+#2]]-#512 ;
#16=SQRT[#14*#14+#15*#15]-#513 ;
IF [#16 LE #28] GOTO 51 ;
#28=#16 ;
N51 IF [#16 GE #29] GOTO 52 ;
#29=#16 ;
N52 #2=#2+1 ;
END1 ;
#516=#28-#29 ;
#17=#514/4. ;
IF [#17 GE 0.02] GOTO 53 ;
#17=0.02 ;
N53 IF [#516 GT #17] GOTO 94 ;
#500=0 ;
M99 ;
N91 #500=1 ;
G00 X#31 ;
#3000=1 (PROBE NEVER TRIGGERED) ;
N92 #500=2 ;
G00 X#31 ;
#3000=2 (PROBE TRIGGERED AT ONCE) ;
N93 #500=3 ;
#3000=3 (3 TO 99 TOUCHES MAKE A CIRCLE) ;
N94 #500=4 ;
#3000=4 (BAND OUT OF ROUND) ;
M99 ;
%
