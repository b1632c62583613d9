; expect: unexpected-word 4:1
BEGIN PGM T MM
L X+10 F100
DEP LT X+10 LEN5 F100
END PGM T MM
