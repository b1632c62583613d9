; expect: bad-arc 3:13
BEGIN PGM T MM
CR X+10 Y+0 R+4.9 DR+ F100
END PGM T MM
