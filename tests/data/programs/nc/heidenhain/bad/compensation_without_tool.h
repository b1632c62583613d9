; expect: compensation-no-tool 3:1
BEGIN PGM T MM
L X+10 RL F100
END PGM T MM
