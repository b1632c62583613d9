; expect: unsupported-word 3:11
BEGIN PGM T MM
CYCL CALL PAT FMAX
END PGM T MM
