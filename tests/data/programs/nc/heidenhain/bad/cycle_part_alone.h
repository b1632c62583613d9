; expect: bad-cycle 3:10
BEGIN PGM T MM
CYCL DEF 7.1 X+5
END PGM T MM
