; expect: unsupported-word 4:12
BEGIN PGM T MM
CC X+5 Y+0
C X+10 Y+0 Z+5 DR+ F100
END PGM T MM
