; expect: unsupported-word 3:1
BEGIN PGM T MM
M103
END PGM T MM
