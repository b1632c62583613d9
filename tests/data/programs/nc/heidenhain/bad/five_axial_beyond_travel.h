; expect: unreachable-orientation 3:1
BEGIN PGM T MM
PLANE AXIAL A+170 TURN FMAX
END PGM T MM
