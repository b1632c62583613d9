; expect: feed-without-spindle 3:1
BEGIN PGM T MM
L X+1 F0.2 M136
END PGM T MM
