(expect: missing-word 2:1)
G68 X0 Y0
