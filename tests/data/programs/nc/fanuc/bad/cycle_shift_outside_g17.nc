(expect: unsupported-word 2:19)
G18 G76 X1 Y-5 R2 I1 F100
M30
