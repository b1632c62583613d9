(expect: bad-nurbs 2:13)
G06.2 P2 K0 X5 Y0 Z0 F100
