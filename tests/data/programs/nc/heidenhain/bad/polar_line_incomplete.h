; expect: missing-word 4:1
BEGIN PGM T MM
CC X+5 Y+0
LP PR+5 F100
END PGM T MM
