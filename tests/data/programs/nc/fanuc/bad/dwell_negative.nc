(expect: out-of-range 2:1)
G04 P-500
M30
