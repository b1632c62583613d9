; expect: unsupported-word 3:1
BEGIN PGM T MM
SEL TABLE "NOWHERE.D"
END PGM T MM
