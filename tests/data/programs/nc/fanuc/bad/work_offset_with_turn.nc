(expect: unexpected-word 2:14)
G10 L2 P1 X5 R3
