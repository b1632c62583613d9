; expect: out-of-domain 3:6
BEGIN PGM T MM
Q1 = TAN 90
END PGM T MM
