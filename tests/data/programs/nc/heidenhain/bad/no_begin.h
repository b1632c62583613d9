; expect: missing-begin 2:1
L X+1 FMAX
END PGM T MM
