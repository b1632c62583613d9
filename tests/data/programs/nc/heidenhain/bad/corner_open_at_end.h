; expect: bad-corner 5:1
BEGIN PGM T MM
L X+10 F100
RND R2
END PGM T MM
