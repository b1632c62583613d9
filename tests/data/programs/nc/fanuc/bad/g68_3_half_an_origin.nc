(expect: missing-word 2:1)
G68.3 X0 Y0
