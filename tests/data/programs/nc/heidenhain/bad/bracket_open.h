; expect: bad-expression 3:12
BEGIN PGM T MM
Q1 = (1 + 2
END PGM T MM
