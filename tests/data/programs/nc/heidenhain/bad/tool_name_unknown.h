; expect: unknown-tool 3:11
BEGIN PGM T MM
TOOL CALL "BALL6" Z
END PGM T MM
