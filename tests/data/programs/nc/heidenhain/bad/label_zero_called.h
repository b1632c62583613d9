; expect: unknown-label 3:10
BEGIN PGM T MM
CALL LBL 0
END PGM T MM
