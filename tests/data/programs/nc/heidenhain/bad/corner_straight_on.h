; expect: bad-corner 4:1
BEGIN PGM T MM
L X+10 F100
RND R2
L X+20
END PGM T MM
