(expect: bad-plane 2:1)
G68.2 P3 Q1 X0 Y0 Z0 I1
