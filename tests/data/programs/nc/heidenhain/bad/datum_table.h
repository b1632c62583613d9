; expect: unsupported-word 4:14
BEGIN PGM T MM
CYCL DEF 7.0 D
CYCL DEF 7.1 #5
END PGM T MM
