; expect: word-twice 3:7
BEGIN PGM T MM
L X+1 IX+2 FMAX
END PGM T MM
