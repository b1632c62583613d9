; expect: bad-corner 4:1
BEGIN PGM T MM
L X+10 F100
CHF 1
CC X+10 Y+5
C X+15 Y+5 DR+
END PGM T MM
