; expect: unknown-word 3:10
BEGIN PGM T MM
CYCL DEF 777 ?
END PGM T MM
