; expect: unknown-word 3:6
BEGIN PGM T MM
Q1 = SINE 30
END PGM T MM
