; expect: words-conflict 4:1
BEGIN PGM T MM
M128
LN X+1 A+5 TX+0 TY+0 TZ+1 F100
END PGM T MM
