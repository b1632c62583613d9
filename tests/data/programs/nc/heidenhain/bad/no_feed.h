; expect: missing-feed 3:1
BEGIN PGM T MM
L X+1
END PGM T MM
