; expect: compensation-entry 5:1
BEGIN PGM T MM
TOOL CALL 1 Z
CC X+10 Y+0
C X+20 Y+0 DR+ RL F100
END PGM T MM
