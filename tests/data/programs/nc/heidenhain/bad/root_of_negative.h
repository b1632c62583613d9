; expect: out-of-domain 3:6
BEGIN PGM T MM
Q1 = SQRT -4
END PGM T MM
