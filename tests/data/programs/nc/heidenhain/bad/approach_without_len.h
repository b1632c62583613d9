; expect: missing-word 3:1
BEGIN PGM T MM
APPR LT X+10 Y+0 RL F100
END PGM T MM
