; expect: unsupported-word 3:1
BEGIN PGM T MM
TRANS BEND RESET
END PGM T MM
