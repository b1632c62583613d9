(expect: out-of-range 2:6)
G154 P100
M30
