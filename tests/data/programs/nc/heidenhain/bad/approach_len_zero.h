; expect: out-of-range 3:20
BEGIN PGM T MM
APPR LT X+10 Y+0   LEN0 RL F100
END PGM T MM
