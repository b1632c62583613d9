; expect: unsupported-word 3:1
BEGIN PGM T MM
APPR LT X+10 A+0 LEN5 RL F100
END PGM T MM
