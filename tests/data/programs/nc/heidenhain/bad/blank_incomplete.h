; expect: missing-word 3:10
BEGIN PGM T MM
BLK FORM 0.1 Z X+0 Y+0
END PGM T MM
