; expect: unknown-word 3:13
BEGIN PGM T MM
PATTERN DEF RING1 (X+1 Y+2 Z+0)
END PGM T MM
