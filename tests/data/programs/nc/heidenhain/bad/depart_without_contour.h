; expect: bad-approach 3:1
BEGIN PGM T MM
DEP LT LEN5 F100
END PGM T MM
