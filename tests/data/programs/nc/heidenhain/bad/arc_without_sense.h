; expect: missing-word 4:1
BEGIN PGM T MM
CC X+5 Y+0
C X+10 Y+0 F100
END PGM T MM
