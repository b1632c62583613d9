; expect: undefined-parameter 3:5
BEGIN PGM T MM
L X+Q1 FMAX
END PGM T MM
