; expect: unreachable-orientation 3:1
BEGIN PGM T MM
PLANE SPATIAL SPA+10 SPB+0 SPC+0 STAY
END PGM T MM
