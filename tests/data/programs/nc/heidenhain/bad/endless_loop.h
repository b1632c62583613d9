; expect: endless-loop 4:29
BEGIN PGM T MM
LBL 1
FN 9: IF +0 EQU +0 GOTO LBL 1
END PGM T MM
