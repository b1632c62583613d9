(expect: out-of-range 2:5)
G82 X1 Z-5 R2 P-10 F100
M30
