; expect: out-of-domain 3:12
BEGIN PGM T MM
FN 4: Q1 = +5 DIV +0
END PGM T MM
