; expect: bad-arc 3:12
BEGIN PGM T MM
CR X+0 Y+0 R+5 DR+ F100
END PGM T MM
