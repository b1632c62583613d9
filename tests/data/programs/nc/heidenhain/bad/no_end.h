; expect: missing-end 3:1
BEGIN PGM T MM
L X+1 FMAX