; expect: bad-corner 3:1
BEGIN PGM T MM
RND R5
L X+1 F100
END PGM T MM
