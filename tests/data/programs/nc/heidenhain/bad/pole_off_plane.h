; expect: unexpected-word 3:3
BEGIN PGM T MM
CC X+5 Y+1 Z+0
END PGM T MM
