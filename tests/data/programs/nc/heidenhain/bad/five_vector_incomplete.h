; expect: missing-word 4:16
BEGIN PGM T MM
M128
LN X+1 Y+2 Z+3 TX+0 TY+1 F100
END PGM T MM
