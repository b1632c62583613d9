; expect: unknown-subprogram 3:10
BEGIN PGM T MM
CALL PGM NOWHERE.H
END PGM T MM
