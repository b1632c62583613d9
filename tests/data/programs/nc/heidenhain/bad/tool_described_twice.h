; expect: word-twice 3:16
BEGIN PGM T MM
TOOL DEF 2 L+0 L+10
END PGM T MM
