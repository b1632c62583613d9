; expect: out-of-domain 3:6
BEGIN PGM T MM
Q1 = LN 0
END PGM T MM
