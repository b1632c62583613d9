; expect: unexpected-word 4:16
BEGIN PGM T MM
CC X+5 Y+0
C X+10 Y+0 DR+ FMAX
END PGM T MM
