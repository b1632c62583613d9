; expect: missing-word 3:5
BEGIN PGM T MM
M140
END PGM T MM
