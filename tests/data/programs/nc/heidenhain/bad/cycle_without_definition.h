; expect: no-cycle 3:1
BEGIN PGM T MM
CYCL CALL
END PGM T MM
