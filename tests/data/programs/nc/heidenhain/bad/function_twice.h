; expect: word-twice 3:15
BEGIN PGM T MM
L X+1 FMAX M3 M3
END PGM T MM
