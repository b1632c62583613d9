; expect: unsupported-word 3:8
BEGIN PGM T MM
L X+10 R+ F100
END PGM T MM
