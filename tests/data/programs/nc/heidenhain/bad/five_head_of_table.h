; expect: unsupported-word 3:1
BEGIN PGM T MM
M144
END PGM T MM
