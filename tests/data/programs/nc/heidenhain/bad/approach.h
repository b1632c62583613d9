; expect: unsupported-word 3:1
BEGIN PGM T MM
APPR LT X+10 Y+0 LEN5 R0 F100
END PGM T MM
