; expect: bad-number 3:4
BEGIN PGM T MM
L X1.2.3 FMAX
END PGM T MM
