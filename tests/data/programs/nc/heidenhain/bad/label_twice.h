; expect: duplicate-label 4:5
BEGIN PGM T MM
LBL 1
LBL 1
CALL LBL 1
END PGM T MM
