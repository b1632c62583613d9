; expect: bad-feed 3:7
BEGIN PGM T MM
L X+1 F0
END PGM T MM
