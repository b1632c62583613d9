(expect: unsupported-word 2:5)
G51 P1500
