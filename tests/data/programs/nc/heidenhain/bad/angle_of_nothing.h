; expect: out-of-domain 3:13
BEGIN PGM T MM
FN 13: Q1 = +0 ANG +0
END PGM T MM
