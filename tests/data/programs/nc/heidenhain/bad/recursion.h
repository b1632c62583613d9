; expect: recursion-limit 4:10
BEGIN PGM T MM
LBL 1
CALL LBL 1
LBL 0
END PGM T MM
