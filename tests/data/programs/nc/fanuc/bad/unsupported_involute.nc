(expect: unsupported-word 2:1)
G02.2 X1 Y1 I1 J1 R1
M30
