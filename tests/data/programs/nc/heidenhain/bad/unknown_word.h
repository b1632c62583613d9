; expect: unknown-word 3:1
BEGIN PGM T MM
LX X+1
END PGM T MM
