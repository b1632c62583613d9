(expect: unexpected-word 2:8)
G01 X1 K1 F100
