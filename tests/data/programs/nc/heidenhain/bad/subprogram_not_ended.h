; expect: missing-end 5:1
BEGIN PGM T MM
CALL LBL 1
LBL 1
END PGM T MM
