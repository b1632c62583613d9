; expect: out-of-range 3:2
BEGIN PGM T MM
Q2000 = 1
END PGM T MM
