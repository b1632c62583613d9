; expect: unknown-subprogram 3:1
BEGIN PGM T MM
CALL SELECTED PGM
END PGM T MM
