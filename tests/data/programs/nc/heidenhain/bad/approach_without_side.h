; expect: missing-word 3:1
BEGIN PGM T MM
APPR LCT X+10 R+10 F100
END PGM T MM
