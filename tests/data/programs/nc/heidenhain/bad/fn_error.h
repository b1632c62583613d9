; expect: program-error 3:14
BEGIN PGM T MM
FN 14: ERROR=1000
END PGM T MM
