; expect: bad-parameter 4:5
BEGIN PGM T MM
QS1 = "A"
L X+QS1 FMAX
END PGM T MM
