; expect: unsupported-word 3:3
BEGIN PGM T MM
L U+1 FMAX
END PGM T MM
