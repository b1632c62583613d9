; expect: unexpected-character 3:7
BEGIN PGM T MM
L X+1 $ FMAX
END PGM T MM
