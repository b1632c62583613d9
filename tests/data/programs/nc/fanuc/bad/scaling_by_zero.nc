(expect: out-of-range 2:5)
G51 P0.0
