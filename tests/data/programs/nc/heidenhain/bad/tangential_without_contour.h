; expect: missing-tangent 3:1
BEGIN PGM T MM
CT X+5 Y+5 F100
END PGM T MM
