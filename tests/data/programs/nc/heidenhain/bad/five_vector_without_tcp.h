; expect: vector-without-tcp 3:12
BEGIN PGM T MM
LN X+1 Y+2 TX+0 TY+0 TZ+1 F100
END PGM T MM
