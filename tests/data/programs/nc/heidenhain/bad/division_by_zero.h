; expect: out-of-domain 3:8
BEGIN PGM T MM
Q1 = 5 / 0
END PGM T MM
