; expect: missing-word 3:1
BEGIN PGM T MM
CR X+10 Y+0 DR+ F100
END PGM T MM
