; expect: word-twice 3:12
BEGIN PGM T MM
L X+1 F100 FMAX
END PGM T MM
