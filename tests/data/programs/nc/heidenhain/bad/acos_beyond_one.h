; expect: out-of-domain 3:6
BEGIN PGM T MM
Q1 = ACOS -1.001
END PGM T MM
