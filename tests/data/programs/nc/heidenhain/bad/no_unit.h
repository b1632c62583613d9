; expect: missing-word 2:1
BEGIN PGM T
L X+1 FMAX
END PGM T
