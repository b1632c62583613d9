; expect: missing-word 3:13
BEGIN PGM T MM
FN 9: IF +1 GT +2 GOTO LBL 1
LBL 1
END PGM T MM
