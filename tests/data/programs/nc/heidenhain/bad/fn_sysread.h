; expect: unsupported-word 3:1
BEGIN PGM T MM
FN 18: SYSREAD Q1 = ID20 NR1
END PGM T MM
