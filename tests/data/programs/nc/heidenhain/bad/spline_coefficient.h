; expect: unknown-word 3:10
BEGIN PGM T MM
SPL X+10 K4X+0 F100
END PGM T MM
