; expect: unexpected-word 4:20
BEGIN PGM T MM
CC X+5 Y+0
C X+10 Y+0 DR+ F10 M128
END PGM T MM
