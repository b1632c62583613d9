; expect: missing-feed 3:7
BEGIN PGM T MM
L X+1 FAUTO
END PGM T MM
