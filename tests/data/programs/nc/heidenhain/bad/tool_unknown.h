; expect: unknown-tool 3:11
BEGIN PGM T MM
TOOL CALL 99 Z
END PGM T MM
