; expect: missing-centre 3:1
BEGIN PGM T MM
C X+10 Y+0 DR+ F100
END PGM T MM
