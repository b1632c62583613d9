; expect: unsupported-word 3:1
BEGIN PGM T MM
FL X+10 AN30
END PGM T MM
