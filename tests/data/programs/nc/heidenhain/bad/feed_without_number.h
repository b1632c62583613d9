; expect: missing-number 3:8
BEGIN PGM T MM
L X+1 F$
END PGM T MM
