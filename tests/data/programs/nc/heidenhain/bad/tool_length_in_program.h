; expect: unsupported-word 3:12
BEGIN PGM T MM
TOOL DEF 1 L+100 R+5
END PGM T MM
