(expect: out-of-range 2:8)
G10 L2 P9 X1
