; expect: bad-number 3:5
BEGIN PGM T MM
L X--1 FMAX
END PGM T MM
