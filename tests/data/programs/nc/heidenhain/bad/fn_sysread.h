; expect: undefined-parameter 4:5
BEGIN PGM T MM
FN 18: SYSREAD Q1 = ID20 NR1
L X+Q1 FMAX
END PGM T MM
