; expect: bad-corner 4:1
BEGIN PGM T MM
L X+10 F100
RND R20
L Y+10
END PGM T MM
