; expect: missing-word 4:1
BEGIN PGM T MM
TOOL CALL 1 Z
L RL F100
END PGM T MM
