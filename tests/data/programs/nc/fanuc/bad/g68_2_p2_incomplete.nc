(expect: bad-plane 2:1)
G68.2 P2 Q1 X0 Y0 Z0
G68.2 P2 Q2 X1 Y0 Z0
G00 X5
