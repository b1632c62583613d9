; expect: word-twice 3:7
BEGIN PGM T MM
L X+1 X+2 FMAX
END PGM T MM
