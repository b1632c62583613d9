; expect: unknown-word 3:1
BEGIN PGM T MM
FN 77: Q1 = +5
END PGM T MM
