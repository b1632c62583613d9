; expect: bad-expression 3:71
BEGIN PGM T MM
Q1 = ((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((1
END PGM T MM
