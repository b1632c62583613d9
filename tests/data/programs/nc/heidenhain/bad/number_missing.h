; expect: missing-number 3:5
BEGIN PGM T MM
L X FMAX
END PGM T MM
