; expect: words-conflict 4:4
BEGIN PGM T MM
CC X+5 Y+0
CP IPA-90 DR+ F100
END PGM T MM
