; expect: missing-word 3:1
BEGIN PGM T MM
SPL X+10 K3X+0 K1X-10 F100
END PGM T MM
