; expect: unreachable-orientation 4:1
BEGIN PGM T MM
M128
LN X+1 Y+2 Z+3 TX+0 TY+0.6 TZ+0.8 F100
END PGM T MM
