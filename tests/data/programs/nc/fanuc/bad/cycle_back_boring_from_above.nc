(expect: bad-cycle 2:1)
G87 X1 Z-5 R2 Q1 F100
M30
