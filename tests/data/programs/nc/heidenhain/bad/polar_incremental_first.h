; expect: missing-word 4:4
BEGIN PGM T MM
CC X+5 Y+0
LP IPR+5 PA+0 F100
END PGM T MM
