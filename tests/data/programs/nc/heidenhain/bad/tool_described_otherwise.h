; expect: words-conflict 3:10
BEGIN PGM T MM
TOOL DEF 2 L+0 R+10
END PGM T MM
