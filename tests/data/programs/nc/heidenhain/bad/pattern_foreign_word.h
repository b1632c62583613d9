; expect: unexpected-word 3:24
BEGIN PGM T MM
PATTERN DEF POS1 (X+1  D+3)
END PGM T MM
