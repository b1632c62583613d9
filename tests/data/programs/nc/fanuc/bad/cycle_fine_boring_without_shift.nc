(expect: missing-word 2:1)
G76 X1 Z-5 R2 F100
M30
