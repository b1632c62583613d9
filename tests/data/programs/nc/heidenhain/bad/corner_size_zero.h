; expect: out-of-range 4:5
BEGIN PGM T MM
L X+10 F100
CHF 0
L Y+10
END PGM T MM
