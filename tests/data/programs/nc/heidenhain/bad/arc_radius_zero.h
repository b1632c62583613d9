; expect: bad-arc 4:1
BEGIN PGM T MM
CC X+0 Y+0
C X+0 Y+0 DR+ F100
END PGM T MM
