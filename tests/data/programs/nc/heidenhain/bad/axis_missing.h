; expect: axis-missing 3:7
BEGIN PGM T MM
L X+1 A+5 FMAX
END PGM T MM
