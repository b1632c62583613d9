; expect: bad-arc 4:1
BEGIN PGM T MM
L X+5 F100
CT X+10 Y+0
END PGM T MM
