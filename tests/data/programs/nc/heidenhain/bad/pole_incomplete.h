; expect: missing-word 3:3
BEGIN PGM T MM
CC X+5
END PGM T MM
